#include "voxdag/render/coarse_cells.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace voxdag {
namespace {

template <class Nodes>
void collect(const Nodes& nodes, typename Nodes::Node node, int level, int last, Vec3i cell,
             std::vector<Vec3i>& cells) {
  if (level == last) {
    cells.push_back(cell);
    return;
  }
  const std::uint32_t mask = nodes.child_mask(node, level);
  for (int i = 0; i < 8; ++i) {
    if ((mask >> i & 1u) == 0) continue;
    const Vec3i child = cell * 2 + Vec3i{i & 1, i >> 1 & 1, i >> 2};
    const bool is_voxel = level + 1 == nodes.levels();
    collect(nodes, is_voxel ? 0 : nodes.child(node, level, i), level + 1, last, child, cells);
  }
}

}  // namespace

CoarseCells::CoarseCells(const VoxelScene& scene, int max_level)
    : level_(std::min(scene.levels(), max_level)), is_set_(std::size_t{1} << (3 * level_)) {
  scene.visit_nodes([&](const auto& nodes) {
    if (!nodes.is_empty()) collect(nodes, nodes.root(), 0, level_, {}, cells_);
  });
  for (const Vec3i cell : cells_) {
    is_set_[index(cell)] = true;
    bounds_.extend(cell);
    bounds_.extend(cell + Vec3i{1, 1, 1});
  }
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

}  // namespace voxdag
