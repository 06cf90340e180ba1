#include "voxdag/render/coarse_cells.hpp"

#include <set>
#include <utility>

namespace voxdag {
namespace {

/// Lowers `best` to the lowest voxel below a node, whose cell begins at `at`, in cells of `level`.
template <class Nodes>
void find_lowest(const Nodes& nodes, typename Nodes::Node node, int level, std::int64_t at,
                 int axis, std::int64_t& best) {
  if (level == nodes.levels()) {
    best = at;
    return;
  }
  const std::uint32_t mask = nodes.child_mask(node, level);
  for (const int side : {0, 1}) {
    const std::int64_t child_at = 2 * at + side;
    if (child_at << (nodes.levels() - level - 1) >= best) return;
    for (int i = 0; i < 8; ++i)
      if ((mask >> i & 1u) != 0 && (i >> axis & 1) == side &&
          child_at << (nodes.levels() - level - 1) < best)
        find_lowest(nodes, level + 1 == nodes.levels() ? node : nodes.child(node, level, i),
                    level + 1, child_at, axis, best);
  }
}

}  // namespace

std::int64_t lowest_voxel(const VoxelSet& scene, int axis) {
  return visit_nodes(scene, [&](const auto& nodes) {
    std::int64_t best = std::int64_t{1} << nodes.levels();
    if (!nodes.is_empty()) find_lowest(nodes, nodes.root(), 0, 0, axis, best);
    return best;
  });
}

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
