#include "voxdag/stream/streamed_image.hpp"

#include <tbb/task_arena.h>

#include <atomic>

#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/cpu/post_filter.hpp"
#include "voxdag/cpu/tile_renderer.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/stream/paged_caster.hpp"

namespace voxdag {
namespace {

/// Requests the blocks that rays miss, and records whether there were any.
class TileListener : public LeafListener {
 public:
  explicit TileListener(const BlockSource& source) : source_(source) {}

  void on_leaf(std::uint64_t slot) const override {
    const std::int64_t block = source_.missing_block(slot);
    if (block < 0) return;
    has_missed_ = true;
    source_.want(static_cast<std::size_t>(block));
  }
  bool has_missed() const { return has_missed_; }

 private:
  const BlockSource& source_;
  mutable bool has_missed_ = false;
};

class StreamedPicture {
 public:
  StreamedPicture(BlockSource& source, const Grid& grid, const RenderOptions& options,
                  Progress* progress)
      : source_(source),
        options_(options),
        progress_(progress),
        plan_(source.view(), grid, options) {
    left_ = make_tiles(options.width, options.height, options.tile_size);
  }

  RenderedImage render(const std::function<void(const RenderedImage&)>& on_pass) {
    source_.begin_part();
    for (;;) {
      make_renderer();
      left_ = render_loaded(left_, "render");
      const std::size_t loaded = source_.load_missing(eye());
      if (left_.empty()) break;
      if (loaded == 0) {
        render_parts();
        break;
      }
      if (on_pass) on_pass(finished(plan_.image()));
    }
    if (options_.with_steps) renderer_->count();
    plan_.image().rays = rays_;
    return finished(std::move(plan_.image()));
  }

 private:
  using Renderer = TileRenderer<ContourNodes, PacketCaster<ContourNodes>>;

  Vec3d eye() { return plan_.image().view.eye; }

  /// Makes a renderer for the blocks that are loaded now, because its beams end at the loaded
  /// voxels.
  void make_renderer() {
    const ContourNodes nodes(source_.view());
    renderer_.emplace(nodes, PacketCaster(nodes), plan_.setup(), options_.beams, nullptr);
  }

  /// Renders tiles with the loaded blocks. Returns the tiles whose rays missed blocks.
  std::vector<ViewTile> render_loaded(const std::vector<ViewTile>& tiles, const char* stage) {
    std::vector<char> has_missed(tiles.size());
    std::atomic<std::size_t> done{0};
    parallel_for(tiles.size(), [&](std::size_t at) {
      if (progress_ != nullptr && progress_->cancelled()) return;
      const TileListener listener(source_);
      const StreamedNodes nodes(source_.view(), listener);
      rays_ += renderer_->render_one(nodes, PacketCaster(nodes), tiles[at]);
      has_missed[at] = listener.has_missed() ? 1 : 0;
      const std::size_t so_far = done.fetch_add(1) + 1;
      if (progress_ != nullptr && stage != nullptr)
        progress_->report(stage, static_cast<double>(so_far) / static_cast<double>(tiles.size()),
                          rays_);
    });
    if (progress_ != nullptr) progress_->throw_if_cancelled();
    std::vector<ViewTile> missed;
    for (std::size_t i = 0; i < tiles.size(); ++i)
      if (has_missed[i] != 0) missed.push_back(tiles[i]);
    return missed;
  }

  /// Renders the remaining tiles, a few at a time.
  void render_parts() {
    const auto at_once = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    for (std::size_t begin = 0; begin < left_.size(); begin += at_once) {
      const auto first = left_.begin() + static_cast<std::ptrdiff_t>(begin);
      std::vector<ViewTile> part(
          first, first + static_cast<std::ptrdiff_t>(std::min(at_once, left_.size() - begin)));
      source_.begin_part();
      do {
        part = render_loaded(part, nullptr);
      } while (source_.load_missing(eye()) > 0 && !part.empty());
      const PagedNodes nodes(source_);
      for (const ViewTile& tile : part)
        rays_ += renderer_->render_one(nodes, PagedCaster(nodes, progress_), tile);
      if (progress_ != nullptr)
        progress_->report("stream", static_cast<double>(begin) / static_cast<double>(left_.size()),
                          rays_);
    }
  }

  RenderedImage finished(RenderedImage image) const {
    filter_picture(image, options_.filter);
    return plan_.finish(std::move(image));
  }

  BlockSource& source_;
  const RenderOptions& options_;
  Progress* progress_;
  RenderPlan plan_;
  std::optional<Renderer> renderer_;
  std::vector<ViewTile> left_;
  std::atomic<std::uint64_t> rays_{0};
};

}  // namespace

RenderedImage render_streamed(BlockSource& source, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass,
                              Progress* progress) {
  return StreamedPicture(source, grid, options, progress).render(on_pass);
}

}  // namespace voxdag
