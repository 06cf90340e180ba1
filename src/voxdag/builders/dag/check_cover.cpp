#include "voxdag/builders/dag/check_cover.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/builders/voxelize/overlap.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

constexpr int kCoarserLevels = 4;
constexpr std::uint64_t kCellsAtOnce = 1 << 20;  // cells

/// Returns a uniform number in [0, 1) that is equal on every machine
/// (std::uniform_real_distribution is not).
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Generates random points of the surface, uniform by area.
class SurfacePoints {
 public:
  SurfacePoints(const QuantizedMesh& mesh, Work work) : mesh_(mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
      work.poll_seldom(i);
      if (mesh.in_range(i)) {
        const QuantizedTriangle t = mesh.triangle(i);
        const Vec3d n = cross(static_cast<Vec3d>(t.y) - static_cast<Vec3d>(t.x),
                              static_cast<Vec3d>(t.z) - static_cast<Vec3d>(t.x));
        // Adds one square voxel, so that triangles without area are sampled, too.
        sum += std::sqrt(dot(n, n)) + kSubvoxels * kSubvoxels;
      }
      areas_.push_back(sum);
    }
  }

  /// Returns the voxel of a random point.
  Vec3i voxel(std::mt19937_64& random) const {
    const double at = uniform(random) * areas_.back();
    const auto it = std::upper_bound(areas_.begin(), areas_.end(), at);
    const std::size_t index = std::min<std::size_t>(it - areas_.begin(), areas_.size() - 1);
    const QuantizedTriangle t = mesh_.triangle(index);
    double u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3d a = static_cast<Vec3d>(t.x), b = static_cast<Vec3d>(t.y),
                c = static_cast<Vec3d>(t.z);
    const Vec3d p = (a + (b - a) * u + (c - a) * v) * (1.0 / kSubvoxels);
    return {static_cast<std::int32_t>(std::floor(p.x)), static_cast<std::int32_t>(std::floor(p.y)),
            static_cast<std::int32_t>(std::floor(p.z))};
  }

 private:
  const QuantizedMesh& mesh_;
  std::vector<double> areas_;  // running sums
};

/// Returns `count` cells of `level`, sorted by x, y and z.
std::vector<Vec3i> sample_cells(const SurfacePoints& surface, int levels, int level,
                                std::uint64_t count, std::mt19937_64& random, Work work) {
  const std::int64_t n = std::int64_t{1} << levels;
  std::vector<Vec3i> cells;
  while (cells.size() < count) {
    work.poll_seldom(cells.size());
    const std::uint64_t kind = random() % 8;
    Vec3i v;
    if (kind == 0) {
      for (int axis = 0; axis < 3; ++axis)
        v[axis] = static_cast<std::int32_t>(random() & static_cast<std::uint64_t>(n - 1));
    } else {
      v = surface.voxel(random);
      // Moves every second sample to a neighbour cell, which is usually not covered.
      const std::int32_t step = std::int32_t{1} << (levels - level);
      if (kind % 2 == 0)
        for (int axis = 0; axis < 3; ++axis)
          v[axis] += (static_cast<std::int32_t>(random() % 3) - 1) * step;
      for (int axis = 0; axis < 3; ++axis)
        v[axis] = static_cast<std::int32_t>(std::clamp<std::int64_t>(v[axis], 0, n - 1));
    }
    const int shift = levels - level;
    cells.push_back({v.x >> shift, v.y >> shift, v.z >> shift});
  }
  std::sort(cells.begin(), cells.end(), [](Vec3i a, Vec3i b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  });
  return cells;
}

/// Returns for each of `cells` (sorted by x) whether a triangle meets it. Tests every triangle
/// against the cells in its box.
std::unique_ptr<std::atomic<bool>[]> covered_cells(const QuantizedMesh& mesh, int levels, int level,
                                                   const std::vector<Vec3i>& cells, Work work) {
  std::unique_ptr<std::atomic<bool>[]> covered(new std::atomic<bool>[cells.size()]());
  const int shift = levels - level + 8;
  const std::int64_t size = std::int64_t{1} << shift;
  polled_for(mesh.triangle_count(), 256, work, "cover", [&](std::size_t index) {
    if (!mesh.in_range(index)) return;
    const QuantizedTriangle t = mesh.triangle(index);
    const Vec3i lo = min(t.x, min(t.y, t.z)), hi = max(t.x, max(t.y, t.z));
    auto it = std::lower_bound(cells.begin(), cells.end(), lo.x >> shift,
                               [](Vec3i cell, std::int32_t x) { return cell.x < x; });
    for (; it != cells.end() && it->x <= hi.x >> shift; ++it) {
      if (it->y < lo.y >> shift || it->y > hi.y >> shift || it->z < lo.z >> shift ||
          it->z > hi.z >> shift)
        continue;
      std::atomic<bool>& flag = covered[it - cells.begin()];
      if (!flag.load(std::memory_order_relaxed) &&
          triangle_overlaps_cube(t.x, t.y, t.z, static_cast<Vec3l>(*it) * size, size))
        flag.store(true, std::memory_order_relaxed);
    }
  });
  return covered;
}

}  // namespace

CoverCheck check_cover(const SvdagView& dag, const Grid& grid, const Mesh& mesh,
                       std::uint64_t samples, std::uint64_t seed, Work work) {
  if (dag.levels != grid.levels) throw Error("the grid and the DAG differ in resolution");
  CoverCheck check;
  if (mesh.triangles.empty()) return check;
  const QuantizedMesh quantized(mesh, grid, work);
  const SurfacePoints surface(quantized, work);
  std::mt19937_64 random(seed);
  const int coarsest = std::max(0, grid.levels - kCoarserLevels);
  std::uint64_t left = samples;
  for (int level = grid.levels; level >= coarsest; --level) {
    // Each level takes half of the samples that are left; the coarsest takes the rest.
    const std::uint64_t to_leave = level == coarsest ? 0 : left / 2;
    while (left > to_leave) {
      const std::uint64_t count = std::min(left - to_leave, kCellsAtOnce);
      left -= count;
      const std::vector<Vec3i> cells =
          sample_cells(surface, grid.levels, level, count, random, work);
      const auto covered = covered_cells(quantized, grid.levels, level, cells, work);
      for (std::size_t i = 0; i < cells.size(); ++i) {
        work.poll_seldom(i);
        const bool expected = covered[i].load(std::memory_order_relaxed);
        check.covered += expected ? 1 : 0;
        if (svdag_contains(dag, cells[i], level) == expected) continue;
        if (check.mismatches++ == 0) {
          check.first_mismatch = cells[i];
          check.first_mismatch_level = level;
        }
      }
      check.samples += count;
    }
  }
  return check;
}

}  // namespace voxdag
