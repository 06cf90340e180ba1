#include "voxdag/stream_cuda/device_stream.hpp"

#include <numeric>

#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/cpu/tile_renderer.hpp"
#include "voxdag/cuda/partial_picture.hpp"
#include "voxdag/cuda/render_pixel.hpp"
#include "voxdag/stream/paged_caster.hpp"
#include "voxdag/stream/streamed_tiles.hpp"

namespace voxdag {
namespace {

/// Renders tiles on the stream's device.
class DeviceTiles : public StreamedTiles {
 public:
  DeviceTiles(DeviceStream& stream, RenderPlan& plan, const RenderOptions& options,
              Progress* progress)
      : stream_(stream),
        plan_(plan),
        progress_(progress),
        picture_(stream.blocks(), plan, options, progress) {}

  std::vector<ViewTile> all() const override {
    std::vector<std::uint32_t> indices(picture_.tile_count());
    std::iota(indices.begin(), indices.end(), 0u);
    return tiles_of(indices);
  }

  void begin_pass() override {
    stream_.update();
    picture_.cast_beams();
  }

  std::vector<ViewTile> render(const std::vector<ViewTile>& tiles, const char* stage) override {
    stream_.update();
    std::vector<std::uint32_t> indices;
    indices.reserve(tiles.size());
    for (const ViewTile& tile : tiles)
      indices.push_back(block_at(plan_.setup().camera, tile.x, tile.y));
    const std::vector<std::uint32_t> missed = picture_.render(indices, stage);
    stream_.want_missed();
    return tiles_of(missed);
  }

  void render_paged(const ViewTile& tile) override { paged_.push_back(tile); }

  void count_steps() override {
    stream_.update();
    picture_.count_steps();
  }

  std::size_t most_at_once() const override { return 256; }
  std::size_t most_paged() const override { return 1; }

  RenderedImage image() override {
    RenderedImage image = plan_.image();
    picture_.copy_to(image);
    return image;
  }

  RenderedImage take_image() override {
    picture_.copy_to(plan_.image());
    render_on_cpu();
    return std::move(plan_.image());
  }

 private:
  std::vector<ViewTile> tiles_of(const std::vector<std::uint32_t>& indices) const {
    std::vector<ViewTile> tiles;
    tiles.reserve(indices.size());
    for (const std::uint32_t index : indices) tiles.push_back(picture_.tile(index));
    return tiles;
  }

  /// Renders the tiles of render_paged() into the picture in the host's memory.
  void render_on_cpu() {
    if (paged_.empty()) return;
    const PagedNodes nodes(stream_.source());
    const PagedCaster caster(nodes, progress_);
    const TileRenderer renderer(nodes, caster, plan_.setup(), false, nullptr);
    for (std::size_t i = 0; i < paged_.size(); ++i) {
      if (progress_ != nullptr) progress_->throw_if_cancelled();
      plan_.image().rays += renderer.render_one(nodes, caster, paged_[i]);
      stream_.add_pixels_on_cpu(paged_[i].pixels());
      if (progress_ != nullptr)
        progress_->report("stream",
                          static_cast<double>(i + 1) / static_cast<double>(paged_.size()));
    }
  }

  DeviceStream& stream_;
  RenderPlan& plan_;
  Progress* progress_;
  PartialPicture picture_;
  std::vector<ViewTile> paged_;
};

}  // namespace

DeviceStream::DeviceStream(const CudaDevice& device, BlockSource& source)
    : source_(&source), blocks_(device, source.view().slot_count, source.block_count()) {
  update();
}

void DeviceStream::update() {
  blocks_.make_current();
  const std::uint64_t version = source_->version();
  blocks_.update(source_->loaded(), source_->changes_since(version_));
  version_ = version;
}

void DeviceStream::want_missed() {
  for (const std::size_t block : blocks_.take_wanted()) source_->want(block);
}

RenderedImage render_streamed(DeviceStream& stream, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass,
                              Progress* progress) {
  RenderPlan plan(stream.source().view(), grid, options);
  DeviceTiles tiles(stream, plan, options, progress);
  return render_passes(stream.source(), tiles, plan, options, on_pass, progress);
}

}  // namespace voxdag
