#include "voxdag/builders/solid/winding/edge_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxdag/builders/solid/winding/morton_order.hpp"
#include "voxdag/builders/solid/winding/winding_point.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kLeafEdges = 4;

double length_of(const BoundaryEdge& edge) {
  return length(static_cast<Vec3d>(edge.b) - static_cast<Vec3d>(edge.a));
}

double distance_to(const BoundaryEdge& edge, Vec3d point) {
  const Vec3d a = static_cast<Vec3d>(edge.a), along = static_cast<Vec3d>(edge.b) - a;
  const double at = std::clamp(dot(point - a, along) / dot(along, along), 0.0, 1.0);
  return length(point - (a + along * at));
}

}  // namespace

EdgeTree::EdgeTree(const CountedVector<BoundaryEdge>& boundary, Work work)
    : edges_(work.memory), nodes_(work.memory) {
  sort_by_place(boundary, edges_, work, [](const BoundaryEdge& edge) {
    return (static_cast<Vec3d>(edge.a) + static_cast<Vec3d>(edge.b)) * 0.5;
  });
  if (!edges_.empty()) add_node(0, edges_.size());
}

EdgeTree::Extent EdgeTree::add_node(std::size_t first, std::size_t count) {
  const std::size_t index = nodes_.size();
  nodes_.push_back({});
  Extent extent;
  if (count <= kLeafEdges) {
    extent.lo = Vec3d{HUGE_VAL, HUGE_VAL, HUGE_VAL};
    extent.hi = -extent.lo;
    nodes_[index].first = static_cast<std::uint32_t>(first);
    nodes_[index].count = static_cast<std::uint32_t>(count);
    for (std::size_t i = first; i < first + count; ++i) {
      extent.length += length_of(edges_[i]) * edges_[i].times / kSphere;
      for (const Vec3i end : {edges_[i].a, edges_[i].b}) {
        extent.lo = min(extent.lo, static_cast<Vec3d>(end));
        extent.hi = max(extent.hi, static_cast<Vec3d>(end));
      }
    }
  } else {
    const Extent low = add_node(first, count / 2),
                 high = add_node(first + count / 2, count - count / 2);
    extent = {min(low.lo, high.lo), max(low.hi, high.hi), low.length + high.length};
  }
  Node& node = nodes_[index];
  node.centre = (extent.lo + extent.hi) * 0.5;
  node.radius = length(extent.hi - extent.lo) / 2;
  node.length = extent.length;
  node.next = static_cast<std::uint32_t>(nodes_.size());
  return extent;
}

double EdgeTree::steepest(Vec3d centre, double radius, double enough) const {
  double bound = 0;
  for (std::size_t i = 0; i < nodes_.size() && bound <= enough;) {
    const Node& node = nodes_[i];
    const double distance = length(node.centre - centre) - node.radius - radius;
    // A ball that is small for its distance counts as one edge at its nearest point.
    if (distance > 2 * node.radius) {
      bound += node.length / (distance * distance);
      i = node.next;
      continue;
    }
    for (std::size_t j = node.first; j < node.first + node.count; ++j) {
      const double gap = distance_to(edges_[j], centre) - radius;
      if (!(gap > 0)) return HUGE_VAL;
      // A line without ends has the field 2 / distance, and a part of it less.
      bound += edges_[j].times / kSphere * std::min(length_of(edges_[j]) / gap, 2.0) / gap;
    }
    ++i;
  }
  return bound;
}

}  // namespace voxdag
