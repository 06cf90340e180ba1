#include "voxdag/mesh_view/mesh_in_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/trace/cell_blocks.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag {
namespace {

std::string text(const Box3d& box) {
  std::string out;
  for (const Vec3d& corner : {box.lo, box.hi})
    for (int axis = 0; axis < 3; ++axis) {
      char number[32];
      std::snprintf(number, sizeof number, "%.6g", corner[axis]);
      out += (out.empty() ? "" : axis == 0 ? " to " : ",") + std::string(number);
    }
  return out;
}

template <class Nodes>
bool has_voxel_near(const Nodes& nodes, Vec3i voxel) {
  if (nodes.is_empty()) return false;
  const int last = nodes.levels() - 1;
  const std::int32_t most = (1 << nodes.levels()) - 1;
  for (int i = 0; i < 27; ++i) {
    const Vec3i at = voxel + Vec3i{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    const Vec3i inside = min(max(at, Vec3i{}), Vec3i{most, most, most});
    if (!(at == inside)) continue;
    typename Nodes::Node node = nodes.root();
    if (!descend(nodes, node, 0, last, {at.x >> 1, at.y >> 1, at.z >> 1})) continue;
    const int child = (at.x & 1) | (at.y & 1) << 1 | (at.z & 1) << 2;
    if ((nodes.child_mask(node, last) >> child & 1u) != 0) return true;
  }
  return false;
}

}  // namespace

void check_mesh_in_grid(const Mesh& mesh, const VoxelSet& scene, const Grid& grid) {
  constexpr std::size_t kSamples = 4096;
  const double side = static_cast<double>(grid.resolution());
  const std::size_t step = std::max<std::size_t>(1, mesh.triangles.size() / kSamples);
  std::size_t inside = 0, covered = 0;
  Box3d bounds = Box3d::empty();
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
    const Vec3d vertex = mesh.position(mesh.triangles[i][i / step % 3]);
    bounds.extend(vertex);
    const Vec3d at = grid.to_grid(vertex);
    // Points on the grid's upper faces may round to just outside.
    const Vec3d p = max(at, Vec3d{}), q = min(p, {side - 0.5, side - 0.5, side - 0.5});
    const Vec3d off = at - q;
    if (!(std::fabs(off.x) <= 1 && std::fabs(off.y) <= 1 && std::fabs(off.z) <= 1)) continue;
    ++inside;
    const auto is_covered = [&](const auto& nodes) {
      return has_voxel_near(nodes, static_cast<Vec3i>(q));
    };
    covered += visit_nodes(scene, is_covered) ? 1 : 0;
  }
  if (inside == 0)
    throw Error("the mesh is not in the grid: the mesh spans " + text(bounds) + ", the grid " +
                text(grid.bounds()));
  if (covered * 10 < inside * 9)
    throw Error("the voxels were not built from this mesh: " + std::to_string(inside - covered) +
                " of " + std::to_string(inside) + " vertices that were looked up have no voxel");
}

}  // namespace voxdag
