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

/// Walks down to the sub-volumes from a cell that the triangle meets.
void descend(const TriangleSetup& setup, std::uint32_t conditions, Vec3i cell, int log2_size,
             int log2_bin, std::uint32_t triangle, Entries& entries) {
  if (log2_size == log2_bin) {
    const Vec3i bin{cell.x >> log2_bin, cell.y >> log2_bin, cell.z >> log2_bin};
    entries.push_back(morton_encode(bin) << 32 | triangle);
    return;
  }
  const std::int32_t half = std::int32_t{1} << (log2_size - 1);
  const ChildConditions children = classify_children(setup, conditions, cell, half);
  for (std::uint32_t left = children.alive; left != 0; left &= left - 1) {
    const int child = std::countr_zero(left);
    const Vec3i at = cell + child_offset(child) * half;
    descend(setup, children.conditions(child), at, log2_size - 1, log2_bin, triangle, entries);
  }
}

void bin_one(const QuantizedMesh& mesh, std::uint32_t index, int levels, int log2_bin,
             Entries& entries) {
  const QuantizedTriangle t = mesh.triangle(index);
  const Vec3i lo = min(t.x, min(t.y, t.z)), hi = max(t.x, max(t.y, t.z));
  const int shift = log2_bin + 8;
  Vec3i first, last;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = lo[axis] >> shift;
    last[axis] = hi[axis] >> shift;
    if (last[axis] < 0 || first[axis] >= 1 << (levels - log2_bin)) return;
  }
  if (first == last) {
    entries.push_back(morton_encode(first) << 32 | index);
    return;
  }
  const TriangleSetup setup = make_triangle_setup(t, {0, 0, 0});
  descend(setup, setup.conditions, {0, 0, 0}, levels, log2_bin, index, entries);
}

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
                            const IndexSet& excluded, MemoryBudget& budget, Progress* progress) {
  const int log2_bin = levels - level;
  tbb::enumerable_thread_specific<Entries> per_thread([&] { return Entries(&budget); });
  polled_for(mesh.triangle_count(), 1024, progress, "bin", [&](std::size_t i) {
    if (!mesh.in_range(i) || excluded.contains(i)) return;
    bin_one(mesh, static_cast<std::uint32_t>(i), levels, log2_bin, per_thread.local());
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
