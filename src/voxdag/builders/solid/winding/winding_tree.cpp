#include "voxdag/builders/solid/winding/winding_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxdag/builders/solid/winding/morton_order.hpp"
#include "voxdag/builders/solid/winding/winding_point.hpp"
#include "voxdag/core/angles.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kLeafTriangles = 8;

/// A sum of angles, as the argument of a product of complex numbers and whole turns.
class AngleSum {
 public:
  /// Adds half the solid angle of a triangle.
  /// (Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983.)
  void add_half(const SeenTriangle& t) {
    const double a = length(t.a), b = length(t.b), c = length(t.c), scale = 1 / (a * b * c);
    add(1 + (dot(t.a, t.b) * c + dot(t.b, t.c) * a + dot(t.c, t.a) * b) * scale,
        t.volume6() * scale);
  }
  /// Returns the sum, in turns.
  double turns() const { return turns_ + arc_tangent(y_, x_) / (2 * std::numbers::pi); }

 private:
  void add(double x, double y) {
    const bool was_below = y_ < 0, is_below = y < 0;
    const double product_x = x_ * x - y_ * y, product_y = x_ * y + y_ * x;
    x_ = product_x, y_ = product_y;
    // Two angles of one half of the plane are past its end if their sum is in the other half.
    if (was_below == is_below && (y_ < 0) != is_below) turns_ += is_below ? -1 : 1;
  }

  double x_ = 1, y_ = 0;
  int turns_ = 0;
};

/// Adds the symmetric part of the outer product of a dipole and its place.
void add_moments(double (&moments)[6], Vec3d dipole, Vec3d place) {
  moments[0] += dipole.x * place.x;
  moments[1] += dipole.y * place.y;
  moments[2] += dipole.z * place.z;
  moments[3] += (dipole.x * place.y + dipole.y * place.x) / 2;
  moments[4] += (dipole.x * place.z + dipole.z * place.x) / 2;
  moments[5] += (dipole.y * place.z + dipole.z * place.y) / 2;
}

}  // namespace

/// Sums over the triangles of a node, from which those of the node above follow.
struct WindingTree::Sums {
  std::uint32_t node = 0;
  double area = 0;
  double second = 0;  ///< Sum of area times squared distance from the centre.
  Vec3d lo, hi;       ///< Bounding box.
};

WindingTree::WindingTree(PageVector<QuantizedTriangle> triangles, Work work)
    : triangles_(work.memory), nodes_(work.memory) {
  sort_by_place(triangles, triangles_, work, [](const QuantizedTriangle& t) {
    return (static_cast<Vec3d>(t.x) + static_cast<Vec3d>(t.y) + static_cast<Vec3d>(t.z)) *
           (1.0 / 3);
  });
  triangles.release();
  if (triangles_.empty()) return;
  const double area = add_node(0, triangles_.size()).area;
  for (Node& node : nodes_) node.share = area > 0 ? node.share / area : 0;
}

WindingTree::Sums WindingTree::add_leaf(std::uint32_t index, std::size_t first, std::size_t count) {
  Sums sums;
  sums.node = index;
  sums.lo = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  sums.hi = -sums.lo;
  Node& node = nodes_[index];
  node.first = static_cast<std::uint32_t>(first);
  node.count = static_cast<std::uint32_t>(count);
  struct Part {
    double area;
    Vec3d dipole, centre;
  } parts[kLeafTriangles];
  Vec3d plain_centre{};
  for (std::size_t i = 0; i < count; ++i) {
    const QuantizedTriangle& t = triangles_[first + i];
    const Vec3d a = static_cast<Vec3d>(t.x), b = static_cast<Vec3d>(t.y),
                c = static_cast<Vec3d>(t.z);
    const Vec3d twice = cross(b - a, c - a);
    parts[i] = {length(twice) / 2, twice * (0.5 / kSphere), (a + b + c) * (1.0 / 3)};
    sums.area += parts[i].area;
    node.dipole = node.dipole + parts[i].dipole;
    node.centre = node.centre + parts[i].centre * parts[i].area;
    plain_centre = plain_centre + parts[i].centre * (1.0 / static_cast<double>(count));
    sums.lo = min(sums.lo, min(a, min(b, c)));
    sums.hi = max(sums.hi, max(a, max(b, c)));
  }
  node.centre = sums.area > 0 ? node.centre * (1 / sums.area) : plain_centre;
  for (std::size_t i = 0; i < count; ++i) {
    const QuantizedTriangle& t = triangles_[first + i];
    add_moments(node.moments, parts[i].dipole, parts[i].centre - node.centre);
    for (const Vec3i corner : {t.x, t.y, t.z}) {
      const Vec3d from_middle = static_cast<Vec3d>(corner) - parts[i].centre,
                  from_centre = static_cast<Vec3d>(corner) - node.centre;
      sums.second += parts[i].area / 12 * dot(from_middle, from_middle);
      node.radius = std::max(node.radius, length(from_centre));
    }
    const Vec3d away = parts[i].centre - node.centre;
    sums.second += parts[i].area * dot(away, away);
  }
  return sums;
}

WindingTree::Sums WindingTree::add_node(std::size_t first, std::size_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({});
  Sums sums;
  if (count <= kLeafTriangles) {
    sums = add_leaf(index, first, count);
  } else {
    // Whole leaves in the first half.
    const std::size_t leaves = (count + kLeafTriangles - 1) / kLeafTriangles;
    const std::size_t half = leaves / 2 * kLeafTriangles;
    const Sums parts[] = {add_node(first, half), add_node(first + half, count - half)};
    Node& node = nodes_[index];
    sums.node = index;
    sums.area = parts[0].area + parts[1].area;
    sums.lo = min(parts[0].lo, parts[1].lo);
    sums.hi = max(parts[0].hi, parts[1].hi);
    for (const Sums& part : parts) {
      const Node& below = nodes_[part.node];
      node.dipole = node.dipole + below.dipole;
      node.centre = node.centre + below.centre * (sums.area > 0 ? part.area / sums.area : 0.5);
    }
    const Vec3d corner = max(node.centre - sums.lo, sums.hi - node.centre);
    double radius = 0;
    for (const Sums& part : parts) {
      const Node& below = nodes_[part.node];
      const Vec3d away = below.centre - node.centre;
      for (int i = 0; i < 6; ++i) node.moments[i] += below.moments[i];
      add_moments(node.moments, below.dipole, away);
      sums.second += part.second + part.area * dot(away, away);
      radius = std::max(radius, length(away) + below.radius);
    }
    node.radius = std::min(radius, length(corner));
  }
  Node& node = nodes_[index];
  // The rest of the expansion after two terms is at most half the square of the distance from the
  // centre times the third derivatives of 1 / distance, which are at most 6 / distance⁴.
  node.spread = 3 / kSphere * sums.second;
  node.share = sums.area;
  node.area = sums.area / kSphere;
  node.next = static_cast<std::uint32_t>(nodes_.size());
  return sums;
}

WindingValue WindingTree::around(Vec3d point, double tolerance) const {
  WindingValue sum;
  for (std::size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const Vec3d to = node.centre - point;
    const double squared = dot(to, to), distance = std::sqrt(squared),
                 gap = std::max(distance - node.radius, 0.0);
    const double gap4 = gap * gap * gap * gap;
    // Errors are shared out by area, or by area over distance², whichever allows more.
    if (gap > 0 && node.spread <= tolerance * std::max(node.share * gap4, node.area * gap * gap)) {
      const double* const m = node.moments;
      const double along = m[0] * to.x * to.x + m[1] * to.y * to.y + m[2] * to.z * to.z +
                           2 * (m[3] * to.x * to.y + m[4] * to.x * to.z + m[5] * to.y * to.z);
      sum.value +=
          (dot(node.dipole, to) + m[0] + m[1] + m[2] - 3 * along / squared) / (squared * distance);
      sum.error += node.spread / gap4;
      i = node.next;
    } else {
      if (node.count > 0) {
        AngleSum angles;
        for (std::size_t j = node.first; j < node.first + node.count; ++j)
          angles.add_half({triangles_[j], point});
        sum.value += angles.turns();
      }
      ++i;
    }
  }
  return sum;
}

}  // namespace voxdag
