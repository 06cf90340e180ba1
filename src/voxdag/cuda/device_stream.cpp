#include "voxdag/cuda/device_stream.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "voxdag/cpu/stream/streamed_tiles.hpp"
#include "voxdag/cuda/partial_picture.hpp"
#include "voxdag/cuda/render_pixel.hpp"

namespace voxdag {
namespace {

/// Renders tiles on the stream's device.
class DeviceTiles : public StreamedTiles {
 public:
  DeviceTiles(DeviceStream& stream, RenderPlan& plan, const RenderOptions& options, Work work)
      : stream_(stream), plan_(plan), work_(work), picture_(stream.blocks(), plan, options, work) {}

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
    const std::vector<std::uint32_t> missed = picture_.render(indices_of(tiles), stage);
    stream_.want_missed();
    return tiles_of(missed);
  }

  /// Renders the tiles ray by ray: each ray waits for one block after another.
  void render_rest(const std::vector<ViewTile>& tiles) override {
    const std::vector<std::uint32_t> indices = indices_of(tiles);
    const auto samples = static_cast<std::size_t>(plan_.setup().settings.samples_per_pixel);
    for (std::size_t begin = 0; begin < indices.size();) {
      const auto part = std::span(indices).subspan(
          begin, std::min<std::size_t>(picture_.most_resumed(), indices.size() - begin));
      for (std::size_t sample = 0; sample < samples; ++sample)
        render_sample(part, static_cast<int>(sample), [&](std::size_t waiting) {
          const auto done =
              static_cast<double>(begin * samples + part.size() * (sample + 1) - waiting);
          work_.report("stream", done / static_cast<double>(indices.size() * samples));
        });
      begin += part.size();
    }
  }

  void count_steps() override {
    stream_.update();
    picture_.count_steps();
  }

  RenderedImage image() override {
    RenderedImage image = plan_.image();
    picture_.copy_to(image);
    return image;
  }

  RenderedImage take_image() override {
    picture_.copy_to(plan_.image());
    return std::move(plan_.image());
  }

 private:
  std::vector<ViewTile> tiles_of(const std::vector<std::uint32_t>& indices) const {
    std::vector<ViewTile> tiles;
    tiles.reserve(indices.size());
    for (const std::uint32_t index : indices) tiles.push_back(picture_.tile(index));
    return tiles;
  }

  std::vector<std::uint32_t> indices_of(const std::vector<ViewTile>& tiles) const {
    std::vector<std::uint32_t> indices;
    indices.reserve(tiles.size());
    for (const ViewTile& tile : tiles)
      indices.push_back(block_at(plan_.setup().camera, tile.x, tile.y));
    return indices;
  }

  /// Renders a sample of the tiles' pixels, in rounds. Each round loads the deepest block for which
  /// rays wait, and the others while there is room. So the rounds end: rays that wait for the
  /// deepest block pass it, or wait for one of its children, which is then the deepest.
  /// Calls `on_round` with the number of tiles that wait.
  template <class OnRound>
  void render_sample(std::span<const std::uint32_t> tiles, int sample, const OnRound& on_round) {
    BlockSource& source = stream_.source();
    for (bool begins = true;; begins = false) {
      stream_.update();
      const std::size_t waiting = picture_.resume(tiles, sample, begins);
      on_round(waiting);
      if (waiting == 0) return;
      const std::vector<std::size_t> wanted = stream_.want_missed();
      source.load(*std::max_element(
          wanted.begin(), wanted.end(),
          [&](std::size_t a, std::size_t b) { return source.depth(a) < source.depth(b); }));
      source.load_missing(plan_.setup().camera.eye);
    }
  }

  DeviceStream& stream_;
  RenderPlan& plan_;
  Work work_;
  PartialPicture picture_;
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

std::vector<std::size_t> DeviceStream::want_missed() {
  std::vector<std::size_t> blocks = blocks_.take_wanted();
  for (const std::size_t block : blocks) source_->want(block);
  return blocks;
}

RenderedImage render_streamed(DeviceStream& stream, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass, Work work) {
  RenderPlan plan(stream.source().view(), grid, options);
  DeviceTiles tiles(stream, plan, options, work);
  return render_passes(stream.source(), tiles, plan, options, on_pass);
}

}  // namespace voxdag
