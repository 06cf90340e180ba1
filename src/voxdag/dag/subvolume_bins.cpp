#include "voxdag/dag/subvolume_bins.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

#include "voxdag/core/morton.hpp"
#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/voxelize/cell_classify.hpp"
#include "voxdag/voxelize/triangle_setup.hpp"

namespace voxdag {
namespace {

using Entries = std::vector<std::uint64_t>;  // Morton code of the cell << 32 | triangle

/// Walks down from a cell that the triangle meets to the sub-volumes.
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
  if (!mesh.in_range(index)) return;
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

}  // namespace

SubvolumeBins bin_triangles(const QuantizedMesh& mesh, int levels, int level, MemoryBudget& budget,
                            const Progress* progress) {
  const int log2_bin = levels - level;
  tbb::enumerable_thread_specific<Entries> per_thread;
  parallel_for(mesh.triangle_count(), 1024, [&](std::size_t i) {
    if (progress != nullptr && progress->cancelled()) return;
    bin_one(mesh, static_cast<std::uint32_t>(i), levels, log2_bin, per_thread.local());
  });
  if (progress != nullptr) progress->throw_if_cancelled();

  std::size_t count = 0;
  for (const Entries& entries : per_thread) count += entries.size();
  budget.add(count * 16);
  Entries all;
  all.reserve(count);
  for (Entries& entries : per_thread) {
    all.insert(all.end(), entries.begin(), entries.end());
    Entries().swap(entries);
  }
  tbb::parallel_sort(all.begin(), all.end());

  SubvolumeBins bins;
  bins.level = level;
  bins.triangles.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t cell = static_cast<std::uint32_t>(all[i] >> 32);
    if (bins.cells.empty() || bins.cells.back() != cell) {
      bins.cells.push_back(cell);
      bins.begin.push_back(i);
    }
    bins.triangles[i] = static_cast<std::uint32_t>(all[i]);
  }
  bins.begin.push_back(count);
  budget.remove(count * 12);
  return bins;
}

}  // namespace voxdag
