#include "voxdag/builders/voxelize/grid_mapping.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

/// The x of a quantized vertex that lies beyond ±kMaxUnits.
constexpr std::int32_t kOutOfRange = std::numeric_limits<std::int32_t>::max();

void require_levels(int levels) {
  if (levels < kMinLevels || levels > kMaxLevels)
    throw Error("a grid must have 2^" + std::to_string(kMinLevels) + " to 2^" +
                std::to_string(kMaxLevels) + " voxels a side, not 2^" + std::to_string(levels));
}

void require_voxel_size(double voxel_size) {
  if (!(voxel_size > 0) || !std::isfinite(kSubvoxels / voxel_size))
    throw Error("the voxel size must be a positive number");
}

/// Refuses the bounds of a mesh without triangles.
void require_triangles(const Box3d& bounds) {
  if (bounds.is_empty()) throw Error("the mesh has no triangles");
}

double longest_side(const Box3d& box) {
  const Vec3d side = box.hi - box.lo;
  return std::max({side.x, side.y, side.z});
}

/// Returns the least number of levels whose grid has at least `voxels` voxels a side.
int levels_for(double voxels) {
  int levels = kMinLevels;
  while (levels <= kMaxLevels && static_cast<double>(std::int64_t{1} << levels) < voxels) ++levels;
  if (levels > kMaxLevels)
    throw Error("the voxel size is too small: the grid would have more than 2^" +
                std::to_string(kMaxLevels) + " voxels a side");
  return levels;
}

/// The mesh of a QuantizedMesh that has none.
const Mesh kNoMesh;

// Clips by Sutherland-Hodgman against the six planes of the box ±kMaxUnits.
void clip(const Vec3<Vec3d>& corners, const Grid& grid, std::vector<QuantizedTriangle>& pieces) {
  std::vector<Vec3d> polygon, kept;
  for (int corner = 0; corner < 3; ++corner)
    polygon.push_back((corners[corner] - grid.origin) * grid.quantization_scale);
  constexpr double kLimit = kMaxUnits;
  for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
    const int axis = plane / 2;
    const double sign = plane % 2 == 0 ? 1 : -1;
    kept.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      const double inside_a = kLimit - sign * a[axis], inside_b = kLimit - sign * b[axis];
      if (inside_a >= 0) kept.push_back(a);
      if ((inside_a >= 0) == (inside_b >= 0)) continue;
      Vec3d cut = a + (b - a) * (inside_a / (inside_a - inside_b));
      cut[axis] = sign * kLimit;
      kept.push_back(cut);
    }
    polygon.swap(kept);
  }
  std::vector<Vec3i> rounded;
  for (const Vec3d& p : polygon) {
    Vec3i q;
    for (int axis = 0; axis < 3; ++axis)
      q[axis] = static_cast<std::int32_t>(std::llround(std::clamp(p[axis], -kLimit, kLimit)));
    rounded.push_back(q);
  }
  for (std::size_t i = 2; i < rounded.size(); ++i)
    pieces.push_back({rounded[0], rounded[i - 1], rounded[i]});
}

}  // namespace

int levels_of(std::int64_t voxels) {
  if (voxels < 1 || voxels > std::int64_t{1} << kMaxLevels)
    throw Error("a grid must have 1 to 2^" + std::to_string(kMaxLevels) + " voxels a side, not " +
                std::to_string(voxels));
  return std::max(kMinLevels,
                  static_cast<int>(std::bit_width(static_cast<std::uint64_t>(voxels - 1))));
}

Grid fit_grid(const Mesh& mesh, int levels) {
  require_levels(levels);
  return fit_grid(referenced_bounds(mesh), levels);
}

Grid fit_grid(const Box3d& bounds, int levels) {
  require_levels(levels);
  return fit_voxels(bounds, std::int64_t{1} << levels);
}

Grid fit_voxels(const Box3d& bounds, std::int64_t voxels) {
  Grid grid;
  grid.levels = levels_of(voxels);
  require_triangles(bounds);
  const double ext = longest_side(bounds);
  const double units = static_cast<double>(voxels * kSubvoxels - 1);
  grid.origin = bounds.lo;
  grid.quantization_scale = ext > 0 ? units / ext : kSubvoxels;
  if (!std::isfinite(grid.quantization_scale))
    throw Error("the mesh is too small: its voxel size cannot be represented");
  grid.voxel_size = kSubvoxels / grid.quantization_scale;
  return grid;
}

Grid grid_from_voxel_size(const Mesh& mesh, double voxel_size) {
  return grid_from_voxel_size(referenced_bounds(mesh), voxel_size);
}

Grid grid_from_voxel_size(const Box3d& bounds, double voxel_size) {
  require_triangles(bounds);
  require_voxel_size(voxel_size);
  // The farthest vertex must round to a unit inside the grid.
  const double scale = kSubvoxels / voxel_size;
  const double last_voxel = std::floor(std::round(longest_side(bounds) * scale) / kSubvoxels);
  return {levels_for(last_voxel + 1), bounds.lo, voxel_size, scale};
}

Grid grid_from_bounds(const Box3d& bounds, int levels) {
  require_levels(levels);
  return divide_bounds(bounds, std::int64_t{1} << levels);
}

Grid divide_bounds(const Box3d& bounds, std::int64_t voxels) {
  const int levels = levels_of(voxels);
  const double side = bounds.is_empty() ? 0 : longest_side(bounds);
  if (!(side > 0) || !std::isfinite(side)) throw Error("the bounds must have a positive size");
  const auto n = static_cast<double>(voxels);
  return {levels, bounds.lo, side / n, n * kSubvoxels / side};
}

Grid grid_from_bounds(const Box3d& bounds, double voxel_size) {
  require_voxel_size(voxel_size);
  const double side = bounds.is_empty() ? 0 : longest_side(bounds);
  if (!(side > 0) || !std::isfinite(side)) throw Error("the bounds must have a positive size");
  // Rounding must not add a voxel: 0.7 - 0.1 divided by 0.1 is 6 but for the last digits.
  const double voxels = side / voxel_size, whole = std::round(voxels);
  double greatest = 0;
  for (int axis = 0; axis < 3; ++axis)
    greatest = std::max({greatest, std::abs(bounds.lo[axis]), std::abs(bounds.hi[axis])});
  const bool is_whole = std::abs(voxels - whole) <= 4 * 0x1p-53 * (greatest / voxel_size + voxels);
  return {levels_for(is_whole ? whole : std::ceil(voxels)), bounds.lo, voxel_size,
          kSubvoxels / voxel_size};
}

std::optional<Vec3i> quantize(const Grid& grid, Vec3d world) {
  Vec3i q;
  for (int axis = 0; axis < 3; ++axis) {
    const double units = (world[axis] - grid.origin[axis]) * grid.quantization_scale;
    if (!(std::fabs(units) <= kMaxUnits)) return std::nullopt;
    // Computes std::llround(units), which would be a call.
    const auto whole = static_cast<std::int32_t>(units);
    const double rest = units - whole;
    q[axis] = whole + (rest >= 0.5 ? 1 : 0) - (rest <= -0.5 ? 1 : 0);
  }
  return q;
}

QuantizedMesh::QuantizedMesh(const Mesh& mesh, const Grid& grid, Work work)
    : mesh_(&mesh),
      vertices_(mesh.vertices.size(), CountedAllocator<Vec3i>(work.memory)),
      added_(CountedAllocator<QuantizedTriangle>(work.memory)),
      added_source_(CountedAllocator<std::uint32_t>(work.memory)) {
  std::atomic<bool> any_out_of_range{false};
  polled_for(vertices_.size(), 4096, work, "quantize", [&](std::size_t i) {
    vertices_[i] = quantize(grid, mesh.position(i)).value_or(Vec3i{kOutOfRange, 0, 0});
    if (vertices_[i].x == kOutOfRange) any_out_of_range.store(true, std::memory_order_relaxed);
  });
  if (!any_out_of_range.load()) return;
  std::vector<QuantizedTriangle> pieces;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    work.poll_seldom(i);
    if (in_range(i)) continue;
    const Triangle& t = mesh.triangles[i];
    pieces.clear();
    clip({mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])}, grid, pieces);
    added_.insert(added_.end(), pieces.begin(), pieces.end());
    added_source_.insert(added_source_.end(), pieces.size(), static_cast<std::uint32_t>(i));
  }
}

QuantizedMesh::QuantizedMesh(CountedVector<QuantizedTriangle> triangles)
    : mesh_(&kNoMesh), added_(std::move(triangles)) {}

bool QuantizedMesh::in_range(std::size_t index) const {
  if (index >= mesh_triangle_count()) return true;
  const auto is_in_range = [this](std::uint32_t v) { return vertices_[v].x != kOutOfRange; };
  const auto [a, b, c] = mesh_->triangles[index];
  return is_in_range(a) && is_in_range(b) && is_in_range(c);
}

QuantizedTriangle QuantizedMesh::triangle(std::size_t index) const {
  if (index >= mesh_triangle_count()) return added_[index - mesh_triangle_count()];
  const auto [a, b, c] = mesh_->triangles[index];
  return {vertices_[a], vertices_[b], vertices_[c]};
}

void quantize_triangle(const Grid& grid, const Vec3<Vec3d>& corners,
                       std::vector<QuantizedTriangle>& triangles) {
  QuantizedTriangle quantized;
  for (int corner = 0; corner < 3; ++corner) {
    const auto q = quantize(grid, corners[corner]);
    if (!q) return clip(corners, grid, triangles);
    quantized[corner] = *q;
  }
  triangles.push_back(quantized);
}

}  // namespace voxdag
