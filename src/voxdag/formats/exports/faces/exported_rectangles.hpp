#pragma once
/// Walks over the rectangles of an export: first to count, then to write them.
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/faces/rectangles.hpp"

namespace voxdag {

/// Every walk visits equal rectangles in equal order.
class ExportedRectangles {
 public:
  /// Keeps references to `voxels` and `options`. Faces have no colours if they are not merged.
  ExportedRectangles(const VoxelSet& voxels, const Box3i& window, const ExportOptions& options,
                     bool merge)
      : voxels_(voxels),
        window_(window),
        options_(options),
        merge_(merge),
        look_(options.look),
        colors_(merge && look_.has_colors() ? &look_ : nullptr) {}

  bool has_colors() const { return colors_ != nullptr; }

  struct Extent {
    std::uint64_t count = 0;
    Box3i bounds = Box3i::empty();  ///< In voxel coordinates.
  };
  /// Counts the rectangles: half of the work.
  Extent measure() {
    Extent extent;
    walk(0.5, [&](const FaceRectangle& rectangle) {
      ++extent.count;
      extent.bounds.extend(rectangle.lo);
      extent.bounds.extend(rectangle.hi);
    });
    return extent;
  }
  /// Calls fn(rectangle) for all rectangles: the rest of the work.
  template <class Fn>
  void for_each(const Fn& fn) {
    walk(1, fn);
  }

 private:
  /// Reports the progress up to `end`.
  void walk(double end, const std::function<void(const FaceRectangle&)>& fn) {
    std::uint64_t done = 0;
    for_each_rectangle(
        voxels_, window_, colors_, merge_,
        [&](double fraction) {
          if (options_.progress) options_.progress(done_ + fraction * (end - done_), done);
        },
        [&](const FaceRectangle& rectangle) {
          ++done;
          fn(rectangle);
        });
    done_ = end;
  }

  const VoxelSet& voxels_;
  Box3i window_;
  const ExportOptions& options_;
  bool merge_;
  LookReader look_;
  LookReader* colors_;
  double done_ = 0;  ///< Fraction of the work.
};

}  // namespace voxdag
