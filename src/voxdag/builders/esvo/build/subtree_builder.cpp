#include "voxdag/builders/esvo/build/subtree_builder.hpp"

#include <algorithm>
#include <bit>

namespace voxdag {
namespace {

/// Cuts the octants of a shape in Morton order, so that octants share the cuts along z and y.
class OctantCutter {
 public:
  explicit OctantCutter(const ConvexPolyhedron& shape) : shape_(shape) {}

  /// Cuts out the octant `child`, which follows those cut before.
  void cut(int child, ConvexPolyhedron& octant) {
    if (last_ < 0 || last_ >> 2 != child >> 2) half_.become_half(shape_, 2, child >> 2 != 0);
    if (last_ < 0 || last_ >> 1 != child >> 1)
      quarter_.become_half(half_, 1, (child >> 1 & 1) != 0);
    octant.become_half(quarter_, 0, (child & 1) != 0);
    last_ = child;
  }

 private:
  const ConvexPolyhedron& shape_;
  ConvexPolyhedron half_, quarter_;
  int last_ = -1;
};

}  // namespace

void SubtreeBuilder::remove_alpha_masked(StackedCell& cell) {
  if (appearance_.sampler().shading() == nullptr) return;
  pieces_.remove_if(cell, [this](const Cell& view, const TrianglePiece& piece) {
    return appearance_.sampler().is_alpha_masked(view, piece);
  });
}

SubtreeBuilder::Visited SubtreeBuilder::visit(StackedCell& cell, bool is_near,
                                              ConvexPolyhedron& shape) {
  remove_alpha_masked(cell);
  if (cell.is_empty()) return {};
  SurfaceSum sum;
  const CellDecision decision = decider_.decide(pieces_.view(cell), is_near, shape, sum);
  Visited visited;
  if (!decision.is_leaf) {
    visited = visit_children(cell, decision.is_near, shape);
  } else {
    visited.sum = sum;
    visited.exists = sum.area > 0;
    visited.is_leaf = true;
  }
  visited.contour = decision.contour;
  return visited;
}

SubtreeBuilder::Visited SubtreeBuilder::visit_children(const StackedCell& cell, bool is_near,
                                                       const ConvexPolyhedron& shape) {
  const PieceStack::Split split = pieces_.begin_split(cell);
  // Leaves without contours need no shapes.
  if (settings_.contours && !is_near && cell.log2_size == 1)
    is_near = CellDecider::is_too_thin(pieces_.view(cell), shape);
  const bool has_shapes = settings_.contours && !is_near;
  OctantCutter cutter(shape);
  Visited children[8];
  for (std::uint32_t left = split.children; left != 0; left &= left - 1) {
    const int child = std::countr_zero(left);
    ConvexPolyhedron octant;
    if (has_shapes) cutter.cut(child, octant);
    StackedCell part = pieces_.push_child(cell, split, child);
    children[child] = visit(part, is_near, octant);
    pieces_.pop(part);
  }
  pieces_.end_split(split);
  return join(children);
}

SubtreeBuilder::Visited SubtreeBuilder::join(const Visited (&children)[8]) {
  Visited result;
  EsvoNode& node = result.node;
  node.first_contour = static_cast<std::uint32_t>(tree_.contours.size());
  node.first_value = static_cast<std::uint32_t>(tree_.values.size());
  for (int child = 0; child < 8; ++child) {
    const Visited& c = children[child];
    if (!c.exists) continue;
    const auto bit = static_cast<std::uint8_t>(1u << child);
    result.exists = true;
    result.sum.add(c.sum);
    node.valid_mask |= bit;
    if (c.is_leaf) node.leaf_mask |= bit;
    if (c.contour) {
      node.contour_mask |= bit;
      tree_.contours.push_back(*c.contour);
    }
    if (settings_.attributes) tree_.values.push_back(voxel_value(c.sum));
  }
  for (int child = 7; child >= 0; --child)
    if (children[child].exists && !children[child].is_leaf)
      tree_.nodes.push_back(children[child].node);
  // The first child was pushed last; build() reverses the order.
  node.first_child = static_cast<std::uint32_t>(tree_.nodes.size()) - 1;
  return result;
}

BuiltVoxel SubtreeBuilder::build(const CellDecision& decision, const ConvexPolyhedron& shape) {
  tree_ = {};
  BuiltVoxel built;
  built.contour = decision.contour;
  StackedCell root = pieces_.root();
  if (decision.is_leaf) {
    remove_alpha_masked(root);
    built.sum = appearance_.sum(pieces_.view(root));
    built.exists = built.sum.area > 0;
    built.is_leaf = true;
    return built;
  }
  const Visited visited = visit_children(root, decision.is_near, shape);
  built.exists = visited.exists;
  built.sum = visited.sum;
  if (!visited.exists) return built;
  tree_.nodes.push_back(visited.node);
  const auto last = static_cast<std::uint32_t>(tree_.nodes.size()) - 1;
  std::reverse(tree_.nodes.begin(), tree_.nodes.end());
  for (EsvoNode& node : tree_.nodes) node.first_child = last - node.first_child;
  built.tree = std::move(tree_);
  return built;
}

}  // namespace voxdag
