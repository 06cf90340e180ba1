#include "voxdag/cpu/stream/streamed_image.hpp"

#include <atomic>

#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/cpu/stream/paged_caster.hpp"
#include "voxdag/cpu/stream/streamed_tiles.hpp"
#include "voxdag/cpu/tile_renderer.hpp"

namespace voxdag {
namespace {

/// Requests the blocks that rays miss, and records whether there were any.
class TileListener : public LeafListener {
 public:
  explicit TileListener(const BlockSource& source) : source_(source) {}

  void on_leaf(std::uint64_t slot) const override {
    const std::int64_t block = source_.loaded().missing_block(slot);
    if (block < 0) return;
    has_missed_ = true;
    source_.want(static_cast<std::size_t>(block));
  }
  bool has_missed() const { return has_missed_; }

 private:
  const BlockSource& source_;
  mutable bool has_missed_ = false;
};

/// Renders tiles on the CPU's threads.
class CpuTiles : public StreamedTiles {
 public:
  CpuTiles(BlockSource& source, RenderPlan& plan, const RenderOptions& options, Work work)
      : source_(source), plan_(plan), options_(options), work_(work) {}

  std::vector<ViewTile> all() const override {
    return make_tiles(options_.width, options_.height, options_.tile_size);
  }

  void begin_pass() override {
    const ContourNodes nodes(source_.view());
    renderer_.emplace(nodes, PacketCaster(nodes), plan_.setup(), options_.beams, nullptr);
  }

  std::vector<ViewTile> render(const std::vector<ViewTile>& tiles, const char* stage) override {
    std::vector<char> has_missed(tiles.size());
    std::atomic<std::size_t> done{0};
    parallel_for(tiles.size(), [&](std::size_t at) {
      if (work_.cancelled()) return;
      const TileListener listener(source_);
      const StreamedNodes nodes(source_.view(), listener);
      rays_ += renderer_->render_one(nodes, PacketCaster(nodes), tiles[at]);
      has_missed[at] = listener.has_missed() ? 1 : 0;
      const std::size_t so_far = done.fetch_add(1) + 1;
      if (stage != nullptr)
        work_.report(stage, static_cast<double>(so_far) / static_cast<double>(tiles.size()), rays_);
    });
    work_.poll();
    std::vector<ViewTile> missed;
    for (std::size_t i = 0; i < tiles.size(); ++i)
      if (has_missed[i] != 0) missed.push_back(tiles[i]);
    return missed;
  }

  /// Renders the tiles a few at a time.
  void render_rest(const std::vector<ViewTile>& tiles) override {
    const Vec3d eye = plan_.setup().camera.eye;
    const auto at_once = thread_count();
    for (std::size_t begin = 0; begin < tiles.size(); begin += at_once) {
      const auto first = tiles.begin() + static_cast<std::ptrdiff_t>(begin);
      std::vector<ViewTile> part(
          first, first + static_cast<std::ptrdiff_t>(std::min(at_once, tiles.size() - begin)));
      source_.begin_part();
      do {
        part = render(part, nullptr);
      } while (source_.load_missing(eye) > 0 && !part.empty());
      const PagedNodes nodes(source_);
      for (const ViewTile& tile : part)
        rays_ += renderer_->render_one(nodes, PagedCaster(nodes, work_), tile);
      work_.report("stream", static_cast<double>(begin) / static_cast<double>(tiles.size()), rays_);
    }
  }

  void count_steps() override { renderer_->count(); }

  RenderedImage image() override { return plan_.image(); }
  RenderedImage take_image() override {
    plan_.image().rays = rays_;
    return std::move(plan_.image());
  }

 private:
  using Renderer = TileRenderer<ContourNodes, PacketCaster<ContourNodes>>;

  BlockSource& source_;
  RenderPlan& plan_;
  const RenderOptions& options_;
  Work work_;
  std::optional<Renderer> renderer_;
  std::atomic<std::uint64_t> rays_{0};
};

}  // namespace

RenderedImage render_streamed(BlockSource& source, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass, Work work) {
  RenderPlan plan(source.view(), grid, options);
  CpuTiles tiles(source, plan, options, work);
  return render_passes(source, tiles, plan, options, on_pass);
}

}  // namespace voxdag
