#include "voxdag/render/coarse_cells.hpp"

#include <set>
#include <utility>

namespace voxdag {

CoarseCells::CoarseCells(const VoxelSet& scene, int max_level)
    : CoarseCells(visit_nodes(scene, [&](const auto& nodes) { return of(nodes, max_level); })) {}

void CoarseCells::add(Vec3i cell) {
  cells_.push_back(cell);
  is_set_[index(cell)] = true;
  bounds_.extend(cell);
  bounds_.extend(cell + Vec3i{1, 1, 1});
}

bool CoarseCells::contains(Vec3i cell) const {
  for (int axis = 0; axis < 3; ++axis)
    if (cell[axis] < 0 || cell[axis] >= side()) return false;
  return is_set_[index(cell)];
}

double CoarseCells::side_cover(int axis, bool from_below, std::int32_t depth) const {
  if (cells_.empty()) return 0;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::set<std::pair<std::int32_t, std::int32_t>> covered;
  for (const Vec3i cell : cells_) {
    const std::int32_t from_side =
        from_below ? cell[axis] - bounds_.lo[axis] : bounds_.hi[axis] - 1 - cell[axis];
    if (from_side < depth) covered.insert({cell[u], cell[v]});
  }
  const double area = static_cast<double>(bounds_.hi[u] - bounds_.lo[u]) *
                      static_cast<double>(bounds_.hi[v] - bounds_.lo[v]);
  return static_cast<double>(covered.size()) / area;
}

Vec3d guess_up(const CoarseCells& scene) {
  const Vec3d y{0, 1, 0}, z{0, 0, 1};
  if (scene.cells().empty()) return y;
  const Vec3i size = scene.bounds().hi - scene.bounds().lo;
  if (size.z * 3 < std::min(size.x, size.y)) return z;
  if (size.y * 3 < std::min(size.x, size.z)) return y;
  const std::int32_t depth = std::max(1, scene.side() / 40);
  return scene.side_cover(2, true, depth) > 2.5 * scene.side_cover(1, true, depth) ? z : y;
}

}  // namespace voxdag
