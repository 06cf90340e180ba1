#pragma once
/// The voxels of a box, one plane of bits after the other.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// The axes (0 to 2, all different) of planes, of the rows of a plane, and of the bits of a row.
struct PlaneAxes {
  int plane, row, column;
};

/// Bits in rows. Column c of a row is bit c % 64 of its word c / 64.
class BitPlane {
 public:
  BitPlane(std::int32_t rows, std::int32_t columns)
      : columns_(columns),
        words_per_row_((static_cast<std::size_t>(columns) + 63) / 64),
        words_(static_cast<std::size_t>(rows) * words_per_row_),
        has_bits_(static_cast<std::size_t>(rows)) {}

  std::int32_t rows() const { return static_cast<std::int32_t>(has_bits_.size()); }
  std::int32_t columns() const { return columns_; }
  std::size_t words_per_row() const { return words_per_row_; }

  /// Returns whether a row may have bits: false only if it has none.
  bool has_bits(std::int32_t row) const { return has_bits_[row] != 0; }
  std::span<const std::uint64_t> row(std::int32_t row) const {
    return {words_.data() + static_cast<std::size_t>(row) * words_per_row_, words_per_row_};
  }
  void set(std::int32_t row, std::int32_t column) {
    has_bits_[row] = 1;
    words_[static_cast<std::size_t>(row) * words_per_row_ +
           static_cast<std::size_t>(column) / 64] |= std::uint64_t{1} << (column & 63);
  }
  /// Clears all bits. O(rows with bits).
  void clear() {
    for (std::size_t row = 0; row < has_bits_.size(); ++row) {
      if (has_bits_[row] == 0) continue;
      std::fill_n(words_.begin() + static_cast<std::ptrdiff_t>(row * words_per_row_),
                  words_per_row_, 0);
      has_bits_[row] = 0;
    }
  }

 private:
  std::int32_t columns_;
  std::size_t words_per_row_;
  std::vector<std::uint64_t> words_;
  std::vector<std::uint8_t> has_bits_;
};

/// Calls fn(begin, end) for the runs of bits of a row, in ascending order.
template <class Fn>
void for_each_run(std::span<const std::uint64_t> row, const Fn& fn) {
  std::int32_t begin = -1;  // of the open run; -1: none is open
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::uint64_t word = row[i];
    const auto base = static_cast<std::int32_t>(64 * i);
    for (int bit = 0; bit < 64;) {
      const std::uint64_t rest = (begin < 0 ? word : ~word) >> bit;
      if (rest == 0) break;
      bit += std::countr_zero(rest);
      if (begin < 0) {
        begin = base + bit;
      } else {
        fn(begin, base + bit);
        begin = -1;
      }
    }
  }
  if (begin >= 0) fn(begin, static_cast<std::int32_t>(64 * row.size()));
}

/// Calls fn(k, plane, before) for all planes of a half-open box inside the grid, k ascending: bit
/// (row, column) of `plane` is the voxel with coordinate k on the axis of planes and
/// box.lo + (row, column) on the others. `before` points to the plane of k - 1, null for the first
/// plane. Both are valid during the call. Holds six planes.
template <class Fn>
void for_each_plane(const VoxelSet& voxels, const Box3i& box, PlaneAxes axes, const Fn& fn) {
  const Vec3i size = box.hi - box.lo;
  const BitPlane empty(size[axes.row], size[axes.column]);
  std::vector<BitPlane> planes(static_cast<std::size_t>(std::min(size[axes.plane], 4)), empty);
  BitPlane last = empty;  // of the slab before
  for (std::int32_t begin = box.lo[axes.plane]; begin < box.hi[axes.plane];) {
    Box3i slab = box;
    slab.lo[axes.plane] = begin;
    // Slabs end at the sides of leaf blocks.
    slab.hi[axes.plane] = std::min((begin | 3) + 1, box.hi[axes.plane]);
    for (BitPlane& plane : planes) plane.clear();
    voxels.for_each_leaf_block(slab, [&](Vec3i origin, std::uint64_t mask) {
      for (; mask != 0; mask &= mask - 1) {
        const Vec3i voxel =
            origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask)));
        planes[voxel[axes.plane] - begin].set(voxel[axes.row] - box.lo[axes.row],
                                              voxel[axes.column] - box.lo[axes.column]);
      }
    });
    const BitPlane* before = begin == box.lo[axes.plane] ? nullptr : &last;
    const BitPlane* plane = planes.data();
    for (; begin < slab.hi[axes.plane]; before = plane++) fn(begin++, *plane, before);
    std::swap(last, planes[before - planes.data()]);
  }
}

/// Returns how many rows of a plane for_each_plane() can hold in `max_bytes`, at least 1.
inline std::int32_t rows_in(std::uint64_t max_bytes, const Box3i& box, PlaneAxes axes) {
  const std::uint64_t columns = box.hi[axes.column] - box.lo[axes.column];
  const std::uint64_t row_bytes = 6 * (((columns + 63) / 64) * 8 + 1);
  return static_cast<std::int32_t>(
      std::clamp<std::uint64_t>(max_bytes / row_bytes, 1, std::uint64_t{1} << 30));
}

/// Calls fn(part) for the parts of a box whose planes for_each_plane() can hold in `max_bytes`:
/// bands of rows, ascending, the whole box if it fits.
template <class Fn>
void for_each_band(const Box3i& box, PlaneAxes axes, std::uint64_t max_bytes, const Fn& fn) {
  const std::int32_t rows = rows_in(max_bytes, box, axes);
  for (std::int32_t begin = box.lo[axes.row]; begin < box.hi[axes.row]; begin += rows) {
    Box3i part = box;
    part.lo[axes.row] = begin;
    part.hi[axes.row] = begin + std::min(rows, box.hi[axes.row] - begin);
    fn(part);
  }
}

/// Calls fn(k, row, bits) for all rows of all planes of a box, in ascending order of planes, then
/// of rows; `row` counts from 0. Holds 48 MiB at most.
template <class Fn>
void for_each_row(const VoxelSet& voxels, const Box3i& box, PlaneAxes axes, const Fn& fn) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{48} << 20;
  const auto rows_of = [&](const Box3i& part) {
    for_each_plane(voxels, part, axes, [&](std::int32_t k, const BitPlane& plane, const BitPlane*) {
      const std::int32_t first = part.lo[axes.row] - box.lo[axes.row];
      for (std::int32_t row = 0; row < plane.rows(); ++row) fn(k, first + row, plane.row(row));
    });
  };
  // One sweep over the box is fastest. If it does not fit, each plane is swept in bands.
  if (box.hi[axes.row] - box.lo[axes.row] <= rows_in(kMaxBytes, box, axes)) return rows_of(box);
  for (std::int32_t k = box.lo[axes.plane]; k < box.hi[axes.plane]; ++k) {
    Box3i plane = box;
    plane.lo[axes.plane] = k;
    plane.hi[axes.plane] = k + 1;
    for_each_band(plane, axes, kMaxBytes, rows_of);
  }
}

}  // namespace voxdag
