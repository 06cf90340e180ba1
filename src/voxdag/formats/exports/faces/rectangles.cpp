#include "voxdag/formats/exports/faces/rectangles.hpp"

#include <utility>
#include <vector>

#include "voxdag/formats/exports/bit_planes.hpp"

namespace voxdag {
namespace {

/// The memory of the planes of voxels.
constexpr std::uint64_t kPlaneBytes = std::uint64_t{48} << 20;

/// Merges the faces of one direction. Rows of planes come in ascending order.
class Merger {
 public:
  Merger(const Box3i& box, PlaneAxes axes, Face face, const VoxelSet& voxels, LookReader* colors,
         bool merge, const std::function<void(const FaceRectangle&)>& fn)
      : box_(box),
        axes_(axes),
        face_(face),
        levels_(voxels.levels()),
        colors_(colors),
        merge_(merge),
        fn_(fn) {}

  /// Adds the faces of the voxels of plane k that `row` has.
  void add_row(std::int32_t k, std::int32_t row, std::span<const std::uint64_t> bits) {
    for_each_run(bits, [&](std::int32_t begin, std::int32_t end) { add_run(k, row, begin, end); });
  }
  /// Ends a row: runs that it did not continue are complete.
  void end_row(std::int32_t k, std::int32_t row) {
    for (const Run& run : open_) close(k, row, run);
    open_.swap(next_);
    next_.clear();
    at_ = 0;
  }
  bool is_idle() const { return open_.empty() && next_.empty(); }

 private:
  struct Run {
    std::int32_t begin, end, first_row;
    Value8 color;
  };

  /// Cuts a run into parts of one colour, or into faces if they are not merged.
  void add_run(std::int32_t k, std::int32_t row, std::int32_t begin, std::int32_t end) {
    if (colors_ == nullptr && merge_) return add_part(row, begin, end, {});
    Value8 color = color_at(k, row, begin);
    for (std::int32_t i = begin + 1; i < end; ++i) {
      const Value8 next = color_at(k, row, i);
      if (merge_ && next == color) continue;
      add_part(row, begin, i, color);
      begin = i;
      color = next;
    }
    add_part(row, begin, end, color);
  }
  void add_part(std::int32_t row, std::int32_t begin, std::int32_t end, Value8 color) {
    Run run{begin, end, row, color};
    // Both lists ascend, so no later run can continue the open runs before this one.
    while (at_ < open_.size() && open_[at_].begin < begin) ++at_;
    if (merge_ && at_ < open_.size() && open_[at_].begin == begin && open_[at_].end == end &&
        open_[at_].color == color) {
      run.first_row = open_[at_].first_row;
      open_[at_].end = open_[at_].begin;  // continued
    }
    next_.push_back(run);
  }
  void close(std::int32_t k, std::int32_t row, const Run& run) {
    if (run.end == run.begin) return;
    FaceRectangle rectangle;
    rectangle.face = face_;
    const std::int32_t side = (static_cast<int>(face_) & 1) != 0 ? 1 : 0;
    rectangle.lo[axes_.plane] = rectangle.hi[axes_.plane] = k + side;
    rectangle.lo[axes_.row] = box_.lo[axes_.row] + run.first_row;
    rectangle.hi[axes_.row] = box_.lo[axes_.row] + row;
    rectangle.lo[axes_.column] = box_.lo[axes_.column] + run.begin;
    rectangle.hi[axes_.column] = box_.lo[axes_.column] + run.end;
    rectangle.color = run.color;
    fn_(rectangle);
  }
  Value8 color_at(std::int32_t k, std::int32_t row, std::int32_t column) {
    if (colors_ == nullptr) return {};
    Vec3i voxel;
    voxel[axes_.plane] = k;
    voxel[axes_.row] = box_.lo[axes_.row] + row;
    voxel[axes_.column] = box_.lo[axes_.column] + column;
    return colors_->read(voxel, levels_).color;
  }

  Box3i box_;
  PlaneAxes axes_;
  Face face_;
  int levels_;
  LookReader* colors_;
  bool merge_;
  const std::function<void(const FaceRectangle&)>& fn_;
  std::vector<Run> open_, next_;  ///< Rectangles of the row before and of this row.
  std::size_t at_ = 0;
};

/// Calls merger.add_row() for the bits of `here` that `beside` has not; `beside` may be null.
void merge_plane(Merger& merger, std::int32_t k, const BitPlane& here, const BitPlane* beside,
                 std::vector<std::uint64_t>& faces) {
  for (std::int32_t row = 0; row < here.rows(); ++row) {
    if (here.has_bits(row)) {
      const std::span<const std::uint64_t> bits = here.row(row);
      faces.assign(bits.begin(), bits.end());
      if (beside != nullptr && beside->has_bits(row))
        for (std::size_t i = 0; i < faces.size(); ++i) faces[i] &= ~beside->row(row)[i];
      merger.add_row(k, row, faces);
    }
    if (!merger.is_idle()) merger.end_row(k, row);
  }
  if (!merger.is_idle()) merger.end_row(k, here.rows());
}

/// Returns the half-open box of the leaf blocks with voxels in a window, cut to the window; an
/// empty one if there are none. Calls poll() from time to time.
Box3i bounds_in(const VoxelSet& voxels, const Box3i& window, const std::function<void()>& poll) {
  constexpr std::uint64_t kBlocksPerPoll = 1 << 16;
  std::uint64_t blocks = 0;
  Box3i bounds{window.hi, window.lo};
  voxels.for_each_leaf_block(window, [&](Vec3i origin, std::uint64_t) {
    if (++blocks % kBlocksPerPoll == 0) poll();
    bounds.lo = min(bounds.lo, max(origin, window.lo));
    bounds.hi = max(bounds.hi, min(origin + Vec3i{4, 4, 4}, window.hi));
  });
  return bounds;
}

}  // namespace

std::array<Vec3i, 4> corners_of(const FaceRectangle& rectangle) {
  const int axis = face_axis(rectangle.face), u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<Vec3i, 4> corners;
  corners.fill(rectangle.lo);
  const bool is_high = (static_cast<int>(rectangle.face) & 1) != 0;
  corners[is_high ? 1 : 3][u] = rectangle.hi[u];
  corners[2][u] = rectangle.hi[u];
  corners[2][v] = rectangle.hi[v];
  corners[is_high ? 3 : 1][v] = rectangle.hi[v];
  return corners;
}

void for_each_rectangle(const VoxelSet& voxels, const Box3i& whole, LookReader* colors, bool merge,
                        const std::function<void(double)>& progress,
                        const std::function<void(const FaceRectangle&)>& fn) {
  // The sweep takes time for each plane, also for those without voxels.
  const Box3i window = bounds_in(voxels, whole, [&] {
    if (progress) progress(0);
  });
  if (window.hi.x <= window.lo.x) return;
  for (int axis = 0; axis < 3; ++axis) {
    const PlaneAxes axes{axis, (axis + 2) % 3, (axis + 1) % 3};
    for_each_band(window, axes, kPlaneBytes, [&](const Box3i& band) {
      const Vec3i size = band.hi - band.lo;
      const auto low = static_cast<Face>(2 * axis), high = static_cast<Face>(2 * axis + 1);
      Merger lows(band, axes, low, voxels, colors, merge, fn);
      Merger highs(band, axes, high, voxels, colors, merge, fn);
      std::vector<std::uint64_t> faces;
      const auto done = [&](std::int32_t k) {
        const double of_band = static_cast<double>(k - band.lo[axis]) / size[axis];
        const double bands =
            static_cast<double>(size[axes.row]) / (window.hi[axes.row] - window.lo[axes.row]);
        const double first = static_cast<double>(band.lo[axes.row] - window.lo[axes.row]) /
                             (window.hi[axes.row] - window.lo[axes.row]);
        return (axis + first + of_band * bands) / 3;
      };
      for_each_plane(voxels, band, axes,
                     [&](std::int32_t k, const BitPlane& here, const BitPlane* before) {
                       if (progress) progress(done(k));
                       merge_plane(lows, k, here, before, faces);
                       if (before != nullptr) merge_plane(highs, k - 1, *before, &here, faces);
                       if (k == band.hi[axis] - 1) merge_plane(highs, k, here, nullptr, faces);
                     });
    });
  }
}

}  // namespace voxdag
