#pragma once
/// Makes the octree of a ball's surface with contours, and packs any octree with colours and
/// normals into blocks.
#include <cmath>
#include <memory>

#include "support/test_esvo.hpp"
#include "voxdag/builders/esvo/encode/pack_blocks.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {

/// A ball in the grid [0,1]³.
struct Ball {
  Vec3d centre{0.5, 0.5, 0.5};
  double radius = 0.4;

  Vec3d normal(Vec3d at) const {
    const Vec3d d = at - centre;
    return d * (1 / std::sqrt(dot(d, d)));
  }
};

/// Returns the contour that encloses the ball's surface in a cell, or none if the surface bends too
/// much there.
inline std::optional<Contour> ball_contour(const Ball& ball, Vec3d middle, double side) {
  const double half = side / 2, reach = half * std::sqrt(3.0);
  const Vec3d from_centre = middle - ball.centre;
  const double distance = std::sqrt(dot(from_centre, from_centre));
  // Largest distance of the surface in the cell from its tangent plane.
  const double bend = reach * reach / (2 * ball.radius) * 1.5;
  if (bend > half / 2) return std::nullopt;
  const Vec3d normal = from_centre * (1 / distance);
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) most = std::max(most, std::fabs(normal[axis]));
  Vec3i n;
  for (int axis = 0; axis < 3; ++axis)
    n[axis] = static_cast<std::int32_t>(std::lround(normal[axis] * Contour::kMaxNormal / most));
  const double length = std::sqrt(dot(static_cast<Vec3d>(n), static_cast<Vec3d>(n)));
  const double cosine = dot(static_cast<Vec3d>(n), normal) / length;
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double at = (ball.radius - distance) / half * length * cosine;
  const double room = length * (bend / half + 2 * sine);
  const auto steps = [&](double v) { return (v / length1(n) + 1) * Contour::kMaxPosition / 2; };
  const auto clamped = [](double p) { return std::max(0, std::min(127, static_cast<int>(p))); };
  return Contour::make(n, clamped(std::floor(steps(at - room))),
                       clamped(std::ceil(steps(at + room))));
}

/// Returns the octree of the voxels below `cell` of level `level` that the ball's surface may pass;
/// null if there are none.
inline std::unique_ptr<TestVoxel> ball_octree(const Ball& ball, int levels, bool with_contours,
                                              int level = 0, Vec3i cell = {}) {
  const double side = std::ldexp(1.0, -level);
  const Vec3d middle = (static_cast<Vec3d>(cell) + Vec3d{0.5, 0.5, 0.5}) * side;
  double least = 0, most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::fabs(middle[axis] - ball.centre[axis]);
    const double inner = std::max(0.0, d - side / 2), outer = d + side / 2;
    least += inner * inner;
    most += outer * outer;
  }
  if (least > ball.radius * ball.radius || most < ball.radius * ball.radius) return nullptr;
  auto voxel = std::make_unique<TestVoxel>();
  if (with_contours && level > 0) voxel->contour = ball_contour(ball, middle, side);
  if (level == levels) return voxel;
  for (int i = 0; i < 8; ++i)
    voxel->children[static_cast<std::size_t>(i)] =
        ball_octree(ball, levels, with_contours, level + 1, cell * 2 + child_offset(i));
  return voxel;
}

/// Appends the descendants of `voxel` to the tree; value(centre of a voxel) returns its VoxelValue.
template <class Value>
void append_to_tree(const TestVoxel& voxel, int level, Vec3i cell, std::uint32_t at,
                    const Value& value, EsvoTree& tree) {
  EsvoNode node;
  node.first_contour = static_cast<std::uint32_t>(tree.contours.size());
  node.first_value = static_cast<std::uint32_t>(tree.values.size());
  const auto child_cell = [&](int i) { return cell * 2 + child_offset(i); };
  for (int i = 0; i < 8; ++i) {
    const TestVoxel* child = voxel.children[static_cast<std::size_t>(i)].get();
    if (child == nullptr) continue;
    const auto bit = static_cast<std::uint8_t>(1 << i);
    node.valid_mask |= bit;
    if (child->is_leaf()) node.leaf_mask |= bit;
    if (child->contour) node.contour_mask |= bit;
    if (child->contour) tree.contours.push_back(*child->contour);
    tree.values.push_back(value((static_cast<Vec3d>(child_cell(i)) + Vec3d{0.5, 0.5, 0.5}) *
                                std::ldexp(1.0, -level - 1)));
  }
  node.first_child = static_cast<std::uint32_t>(tree.nodes.size());
  tree.nodes.resize(tree.nodes.size() + node.inner_count());
  tree.nodes[at] = node;
  std::uint32_t next = node.first_child;
  for (int i = 0; i < 8; ++i)
    if ((node.inner_mask() >> i & 1u) != 0)
      append_to_tree(*voxel.children[static_cast<std::size_t>(i)], level + 1, child_cell(i), next++,
                     value, tree);
}

/// Packs the octree into blocks with colours and normals.
template <class Value>
Esvo pack_with_values(const TestVoxel& root, int levels, const Value& value) {
  EsvoTree tree;
  tree.nodes.resize(1);
  append_to_tree(root, 0, {}, 0, value, tree);
  return pack_octree(std::move(tree), levels);
}

}  // namespace voxdag
