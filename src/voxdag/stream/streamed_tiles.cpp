#include "voxdag/stream/streamed_tiles.hpp"

#include <algorithm>

#include "voxdag/cpu/post_filter.hpp"

namespace voxdag {
namespace {

using Tiles = std::vector<ViewTile>;

class Passes {
 public:
  Passes(BlockSource& source, StreamedTiles& tiles, Vec3d eye, Progress* progress)
      : source_(source), tiles_(tiles), eye_(eye), progress_(progress) {}

  /// Renders all tiles; calls `on_pass` after each pass but the last.
  void run(const std::function<void()>& on_pass) {
    source_.begin_part();
    Tiles left = tiles_.all();
    for (;;) {
      tiles_.begin_pass();
      left = tiles_.render(left, "render");
      const std::size_t loaded = source_.load_missing(eye_);
      if (left.empty()) return;
      if (loaded == 0) return render_parts(left);
      on_pass();
    }
  }

 private:
  /// Renders the remaining tiles, a few at a time.
  void render_parts(const Tiles& left) {
    std::size_t at_once = tiles_.most_at_once();
    for (std::size_t begin = 0; begin < left.size();) {
      const auto first = left.begin() + static_cast<std::ptrdiff_t>(begin);
      const std::size_t count = std::min(at_once, left.size() - begin);
      const bool has_fitted = render_part({first, first + static_cast<std::ptrdiff_t>(count)});
      // The tiles that follow probably need as much memory.
      at_once = has_fitted ? std::min(2 * at_once, tiles_.most_at_once())
                           : std::max(at_once / 2, tiles_.most_paged());
      begin += count;
      if (progress_ != nullptr)
        progress_->report("stream", static_cast<double>(begin) / static_cast<double>(left.size()));
    }
  }

  /// Renders tiles and returns whether their blocks fitted into memory together.
  bool render_part(Tiles part) {
    source_.begin_part();
    do {
      part = tiles_.render(part, nullptr);
    } while (source_.load_missing(eye_) > 0 && !part.empty());
    if (part.empty()) return true;
    if (part.size() > tiles_.most_paged()) {
      const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
      render_part({part.begin(), middle});
      render_part({middle, part.end()});
    } else {
      for (const ViewTile& tile : part) tiles_.render_paged(tile);
    }
    return false;
  }

  BlockSource& source_;
  StreamedTiles& tiles_;
  Vec3d eye_;
  Progress* progress_;
};

}  // namespace

RenderedImage render_passes(BlockSource& source, StreamedTiles& tiles, const RenderPlan& plan,
                            const RenderOptions& options,
                            const std::function<void(const RenderedImage&)>& on_pass,
                            Progress* progress) {
  const auto finished = [&](RenderedImage image) {
    filter_picture(image, options.filter);
    return plan.finish(std::move(image));
  };
  Passes(source, tiles, plan.setup().camera.eye, progress).run([&] {
    if (on_pass) on_pass(finished(tiles.image()));
  });
  if (options.with_steps) tiles.count_steps();
  return finished(tiles.take_image());
}

}  // namespace voxdag
