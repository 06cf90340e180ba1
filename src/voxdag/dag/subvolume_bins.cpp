#include "voxdag/dag/subvolume_bins.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <bit>
#include <vector>

#include "voxdag/core/morton.hpp"
#include "voxdag/parallel/polled_for.hpp"
#include "voxdag/voxelize/cell_classify.hpp"
#include "voxdag/voxelize/triangle_setup.hpp"

namespace voxdag {
namespace {

using Entries = PageVector<std::uint64_t>;  // Morton code of the cell << 32 | triangle
using Cursors = std::array<std::size_t, 4096>;

/// Appends the cells of one level and range that triangles meet.
class TriangleBinner {
 public:
  TriangleBinner(int levels, int level, const CellRange& range)
      : levels_(levels), level_(level), log2_bin_(levels - level), range_(range) {}

  void bin(const QuantizedTriangle& t, std::uint32_t index, Entries& entries) const {
    const Vec3i lo = min(t.x, min(t.y, t.z)), hi = max(t.x, max(t.y, t.z));
    const int shift = log2_bin_ + 8;
    Vec3i first, last;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = lo[axis] >> shift;
      last[axis] = hi[axis] >> shift;
      if (last[axis] < 0 || first[axis] >= 1 << level_) return;
    }
    if (first == last) return add(morton_encode(first), index, entries);
    const TriangleSetup setup = make_triangle_setup(t, {0, 0, 0});
    descend(setup, setup.conditions, {0, 0, 0}, 0, 0, index, entries);
  }

 private:
  void add(std::uint64_t code, std::uint32_t index, Entries& entries) const {
    if (range_.meets(level_, static_cast<std::uint32_t>(code)))
      entries.push_back(code << 32 | index);
  }

  /// Walks down to the sub-volumes from a cell that the triangle meets. The cell's first voxel is
  /// `origin`, its Morton code `code`.
  void descend(const TriangleSetup& setup, std::uint32_t conditions, Vec3i origin, int level,
               std::uint32_t code, std::uint32_t index, Entries& entries) const {
    if (!range_.meets(level, code)) return;
    if (level == level_) return add(code, index, entries);
    const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
    const ChildConditions children = classify_children(setup, conditions, origin, half);
    for (std::uint32_t left = children.alive; left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      descend(setup, children.conditions(child), origin + child_offset(child) * half, level + 1,
              code << 3 | static_cast<std::uint32_t>(child), index, entries);
    }
  }

  int levels_, level_, log2_bin_;
  CellRange range_;
};

/// Moves the entries of all `parts` to one array, sorted stably by the 12 bits of the cell from bit
/// `shift` up. Frees the parts.
Entries sort_by_digit(std::vector<Entries>& parts, int shift, MemoryBudget& budget,
                      const Progress* progress) {
  const auto digit_of = [shift](std::uint64_t entry) {
    return (entry >> (32 + shift)) % std::tuple_size_v<Cursors>;
  };
  Cursors next{};
  for (const Entries& part : parts)
    for (std::size_t i = 0; i < part.size(); ++i) {
      poll_seldom(progress, i);
      ++next[digit_of(part[i])];
    }
  std::size_t count = 0;
  for (std::size_t& cursor : next) count += std::exchange(cursor, count);
  Entries sorted(&budget);
  sorted.resize(count);
  for (Entries& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      poll_seldom(progress, i);
      sorted[next[digit_of(part[i])]++] = part[i];
    }
    part.release();
  }
  return sorted;
}

}  // namespace

// Sorts the cells' codes by a radix sort with 12-bit digits, the lowest first.
SubvolumeBins bin_triangles(const QuantizedMesh& mesh, int levels, int level,
                            const CellRange& range, const IndexSet& excluded, MemoryBudget& budget,
                            Progress* progress) {
  const TriangleBinner binner(levels, level, range);
  tbb::enumerable_thread_specific<Entries> per_thread([&] { return Entries(&budget); });
  polled_for(mesh.triangle_count(), 1024, progress, "bin", [&](std::size_t i) {
    if (!mesh.in_range(i) || excluded.contains(i)) return;
    binner.bin(mesh.triangle(i), static_cast<std::uint32_t>(i), per_thread.local());
  });
  std::vector<Entries> parts;
  for (Entries& entries : per_thread) parts.push_back(std::move(entries));
  for (int shift = 0; shift == 0 || shift < 3 * level; shift += 12) {
    Entries sorted = sort_by_digit(parts, shift, budget, progress);
    parts.clear();
    parts.push_back(std::move(sorted));
  }

  const Entries& all = parts[0];
  SubvolumeBins bins(&budget);
  bins.level = level;
  bins.triangles.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    poll_seldom(progress, i);
    const std::uint32_t cell = static_cast<std::uint32_t>(all[i] >> 32);
    if (bins.cells.empty() || bins.cells.back() != cell) {
      bins.cells.push_back(cell);
      bins.begin.push_back(i);
    }
    bins.triangles[i] = static_cast<std::uint32_t>(all[i]);
  }
  bins.begin.push_back(all.size());
  return bins;
}

}  // namespace voxdag
