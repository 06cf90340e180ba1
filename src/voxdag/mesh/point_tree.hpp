#pragma once
/// A k-d tree of points of the plane (J. L. Bentley, "Multidimensional Binary Search Trees", 1975).
/// Points can be added and removed; the tree finds points that lie in a triangle.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxdag {

struct PlanePoint {
  double x = 0, y = 0;
  friend bool operator==(const PlanePoint&, const PlanePoint&) = default;
};

/// Returns twice the signed area of a triangle: positive if it is counter-clockwise.
inline double signed_area(PlanePoint a, PlanePoint b, PlanePoint c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A k-d tree of distinct points. Each point is present or absent. A search skips subtrees without
/// present points.
class PointTree {
 public:
  /// Builds the tree. All points are absent at first.
  explicit PointTree(std::vector<PlanePoint> points)
      : points_(std::move(points)), slot_of_(points_.size()), present_(points_.size(), 0) {
    std::vector<std::uint32_t> order(points_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    build(order, 0, order.size(), 0);
    order_ = std::move(order);
    for (std::uint32_t slot = 0; slot < order_.size(); ++slot) slot_of_[order_[slot]] = slot;
    is_present_.assign(points_.size(), false);
  }

  /// Makes a point present or absent. Time: log n.
  void set_present(std::uint32_t point, bool is_present) {
    const std::size_t slot = slot_of_[point];
    if (is_present_[slot] == is_present) return;
    is_present_[slot] = is_present;
    for (std::size_t first = 0, last = order_.size();;) {
      const std::size_t middle = first + (last - first) / 2;
      present_[middle] += is_present ? 1u : ~0u;
      if (slot == middle) return;
      (slot < middle ? last : first) = slot < middle ? middle : middle + 1;
    }
  }

  /// Returns whether is_hit(p) is true for a present point p in the closed, counter-clockwise
  /// triangle. Adds the number of visited nodes to `visits`.
  template <class IsHit>
  bool any_in(PlanePoint a, PlanePoint b, PlanePoint c, std::uint64_t& visits,
              const IsHit& is_hit) const {
    const PlanePoint corners[3] = {a, b, c};
    const Box box{{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                  {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}};
    return search(corners, box, 0, order_.size(), 0, visits, is_hit);
  }

 private:
  struct Box {
    PlanePoint lo, hi;
  };

  double key(std::uint32_t point, int axis) const {
    return axis == 0 ? points_[point].x : points_[point].y;
  }

  void build(std::vector<std::uint32_t>& order, std::size_t first, std::size_t last, int axis) {
    if (last - first < 2) return;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t i, std::uint32_t j) {
      return std::pair(key(i, axis), i) < std::pair(key(j, axis), j);
    });
    build(order, first, middle, 1 - axis);
    build(order, middle + 1, last, 1 - axis);
  }

  /// Searches the slots from `first` to `last`. `box` contains the part of the triangle in which
  /// their points can lie.
  template <class IsHit>
  bool search(const PlanePoint (&corners)[3], const Box& box, std::size_t first, std::size_t last,
              int axis, std::uint64_t& visits, const IsHit& is_hit) const {
    if (first == last) return false;
    const std::size_t middle = first + (last - first) / 2;
    if (present_[middle] == 0 || is_outside(corners, box)) return false;
    ++visits;
    const std::uint32_t point = order_[middle];
    const PlanePoint p = points_[point];
    if (is_present_[middle] && signed_area(corners[0], corners[1], p) >= 0 &&
        signed_area(corners[1], corners[2], p) >= 0 &&
        signed_area(corners[2], corners[0], p) >= 0 && is_hit(p))
      return true;
    Box low = box, high = box;
    (axis == 0 ? low.hi.x : low.hi.y) = key(point, axis);
    (axis == 0 ? high.lo.x : high.lo.y) = key(point, axis);
    return search(corners, low, first, middle, 1 - axis, visits, is_hit) ||
           search(corners, high, middle + 1, last, 1 - axis, visits, is_hit);
  }

  /// Returns whether the box is empty or lies completely outside one edge of the triangle.
  static bool is_outside(const PlanePoint (&corners)[3], const Box& box) {
    if (box.lo.x > box.hi.x || box.lo.y > box.hi.y) return true;
    for (int i = 0; i < 3; ++i) {
      const PlanePoint a = corners[i], b = corners[(i + 1) % 3];
      const PlanePoint innermost{b.y > a.y ? box.lo.x : box.hi.x, b.x > a.x ? box.hi.y : box.lo.y};
      if (signed_area(a, b, innermost) < 0) return true;
    }
    return false;
  }

  std::vector<PlanePoint> points_;
  std::vector<std::uint32_t> order_;  ///< Point of each slot; a subtree's root is its middle slot.
  std::vector<std::uint32_t> slot_of_;  ///< Slot of each point.
  std::vector<std::uint32_t> present_;  ///< Per slot: number of present points in its subtree.
  std::vector<bool> is_present_;        ///< Per slot.
};

}  // namespace voxdag
