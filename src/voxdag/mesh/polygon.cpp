/// Ear clipping (G. H. Meisters, "Polygons have ears", 1975): a corner whose triangle holds no
/// other corner is cut off, until a triangle is left. Only reflex corners can lie in the triangle
/// of another, and they are looked up in a k-d tree. A corner once found to be no ear can become
/// one only when a neighbour is cut off, so that each cut costs two tests.
#include "voxdag/mesh/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace voxdag {
namespace {

struct Point {
  double x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// Twice the area of a triangle: positive if it turns left.
double area(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Twice the area of a fan's triangle in space, as a vector.
Vec3d area(const Triangle& triangle, std::span<const Vec3f> vertices) {
  const Vec3d a(vertices[triangle[0]]), b(vertices[triangle[1]]), c(vertices[triangle[2]]);
  return cross(b - a, c - a);
}

/// Points in a tree of halves, alternately by x and by y: which of them are in a triangle?
class PointTree {
 public:
  PointTree(const std::vector<Point>& points, std::vector<std::uint32_t> members)
      : points_(points), members_(std::move(members)) {
    build(0, members_.size(), 0);
  }

  /// Whether is_hit(member) is true for a member in the closed triangle, which turns left.
  template <class IsHit>
  bool any_in(Point a, Point b, Point c, const IsHit& is_hit) const {
    const Point corners[3] = {a, b, c};
    const Box box{{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                  {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}};
    return search(corners, box, 0, members_.size(), 0, is_hit);
  }

 private:
  struct Box {
    Point lo, hi;
  };

  double key(std::uint32_t member, int axis) const {
    return axis == 0 ? points_[member].x : points_[member].y;
  }

  void build(std::size_t first, std::size_t last, int axis) {
    if (last - first < 2) return;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [this](std::size_t i) {
      return members_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t i, std::uint32_t j) {
      return std::pair(key(i, axis), i) < std::pair(key(j, axis), j);
    });
    build(first, middle, 1 - axis);
    build(middle + 1, last, 1 - axis);
  }

  /// Searches the part of the triangle that lies in `box`, which is known to hold all of it that
  /// concerns these members.
  template <class IsHit>
  bool search(const Point (&corners)[3], const Box& box, std::size_t first, std::size_t last,
              int axis, const IsHit& is_hit) const {
    if (first == last || is_outside(corners, box)) return false;
    const std::size_t middle = first + (last - first) / 2;
    const std::uint32_t member = members_[middle];
    const Point p = points_[member];
    if (area(corners[0], corners[1], p) >= 0 && area(corners[1], corners[2], p) >= 0 &&
        area(corners[2], corners[0], p) >= 0 && is_hit(member))
      return true;
    Box low = box, high = box;
    (axis == 0 ? low.hi.x : low.hi.y) = key(member, axis);
    (axis == 0 ? high.lo.x : high.lo.y) = key(member, axis);
    return search(corners, low, first, middle, 1 - axis, is_hit) ||
           search(corners, high, middle + 1, last, 1 - axis, is_hit);
  }

  /// Whether an edge of the triangle, or the lack of room, keeps it out of the box.
  static bool is_outside(const Point (&corners)[3], const Box& box) {
    if (box.lo.x > box.hi.x || box.lo.y > box.hi.y) return true;
    for (int i = 0; i < 3; ++i) {
      const Point a = corners[i], b = corners[(i + 1) % 3];
      const Point innermost{b.y > a.y ? box.lo.x : box.hi.x, b.x > a.x ? box.hi.y : box.lo.y};
      if (area(a, b, innermost) < 0) return true;
    }
    return false;
  }

  const std::vector<Point>& points_;
  std::vector<std::uint32_t> members_;
};

class EarClipper {
 public:
  /// `points` are the corners of a polygon that turns left on the whole.
  explicit EarClipper(const std::vector<Point>& points)
      : points_(points),
        next_(points.size()),
        previous_(points.size()),
        is_waiting_(points.size(), false),
        left_(points.size()),
        reflex_(points, link()) {}

  /// Calls on_triangle(a, b, c) with indices of corners: two times fewer than there are corners.
  template <class OnTriangle>
  void run(const OnTriangle& on_triangle) {
    std::vector<std::uint32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0u);
    clip(all, Ear::kClear, on_triangle);
    // What is left crosses itself, or touches itself in more than corners.
    for (const Ear least : {Ear::kTouched, Ear::kConvex, Ear::kAny})
      for (const std::uint32_t corner : all) clip({corner}, least, on_triangle);
  }

 private:
  /// What is asked of a corner, from the most on.
  enum class Ear {
    kClear,    ///< Convex, and no other corner in its triangle or on its edges.
    kTouched,  ///< Convex, and no other corner within its triangle.
    kConvex,
    kAny
  };

  /// Makes the ring of corners; returns those that are not convex.
  std::vector<std::uint32_t> link() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = i + 1 == count ? 0 : i + 1;
      previous_[next_[i]] = i;
    }
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < count; ++i)
      if (corner_area(i) <= 0) reflex.push_back(i);
    return reflex;
  }

  double corner_area(std::uint32_t i) const {
    return area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }
  bool is_cut(std::uint32_t i) const { return next_[i] == i; }

  bool is_ear(std::uint32_t i, Ear least) const {
    if (least == Ear::kAny) return true;
    const double size = corner_area(i);
    if (size <= 0 || least == Ear::kConvex) return size >= 0;  // No area: nothing can be in it.
    const Point a = points_[previous_[i]], b = points_[i], c = points_[next_[i]];
    return !reflex_.any_in(a, b, c, [&](std::uint32_t other) {
      const Point p = points_[other];
      // Corners in the same place are how a polygon goes around its holes.
      if (is_cut(other) || p == a || p == b || p == c || corner_area(other) > 0) return false;
      return least == Ear::kClear || (area(a, b, p) > 0 && area(b, c, p) > 0 && area(c, a, p) > 0);
    });
  }

  /// Cuts off what it can of `corners`, then of the neighbours of those, and so on. Neighbours wait
  /// for the next round: triangles stay rounder.
  template <class OnTriangle>
  void clip(std::vector<std::uint32_t> corners, Ear least, const OnTriangle& on_triangle) {
    std::vector<std::uint32_t> waiting;
    while (!corners.empty() && left_ > 2) {
      for (const std::uint32_t i : corners) {
        if (left_ <= 2 || is_cut(i) || is_waiting_[i] || !is_ear(i, least)) continue;
        const std::uint32_t before = previous_[i], after = next_[i];
        on_triangle(before, i, after);
        next_[before] = after;
        previous_[after] = before;
        next_[i] = i;
        --left_;
        for (const std::uint32_t neighbour : {before, after}) {
          if (is_waiting_[neighbour]) continue;
          is_waiting_[neighbour] = true;
          waiting.push_back(neighbour);
        }
      }
      least = Ear::kClear;
      for (const std::uint32_t i : waiting) is_waiting_[i] = false;
      corners.clear();
      corners.swap(waiting);
    }
  }

  const std::vector<Point>& points_;
  std::vector<std::uint32_t> next_, previous_;  ///< A corner that is cut off is its own next.
  std::vector<bool> is_waiting_;
  std::size_t left_;
  const PointTree reflex_;
};

/// The corners of a polygon as seen against its unit normal: they turn left on the whole.
std::vector<Point> project(std::span<const std::uint32_t> corners, std::span<const Vec3f> vertices,
                           Vec3d normal) {
  // The axis after the one that the normal is nearest to: well apart from it, and for a normal
  // along an axis the projection is exact.
  const Vec3d size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const Vec3d axis = size.x >= size.y && size.x >= size.z ? Vec3d{0, 1, 0}
                     : size.y >= size.z                   ? Vec3d{0, 0, 1}
                                                          : Vec3d{1, 0, 0};
  const Vec3d across = cross(normal, axis);
  const Vec3d u = cross(across, normal);
  const Vec3d origin(vertices[corners[0]]);
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const Vec3d p = Vec3d(vertices[corner]) - origin;
    points.push_back({dot(p, u), dot(p, across)});
  }
  return points;
}

}  // namespace

void cut_polygon(std::span<Triangle> fan, std::span<const Vec3f> vertices) {
  if (fan.size() < 2) return;
  Vec3d normal;  // M. Newell's: the sum of the areas; the same for any fan of the polygon.
  for (const Triangle& triangle : fan) normal = normal + area(triangle, vertices);
  normal = normalized_or(normal, {});
  if (normal == Vec3d{}) return;
  if (std::all_of(fan.begin(), fan.end(), [&](const Triangle& triangle) {
        return dot(area(triangle, vertices), normal) >= 0;
      }))
    return;

  std::vector<std::uint32_t> corners{fan[0][0], fan[0][1]};
  corners.reserve(fan.size() + 2);
  for (const Triangle& triangle : fan) corners.push_back(triangle[2]);
  const std::vector<Point> points = project(corners, vertices, normal);
  auto out = fan.begin();
  EarClipper(points).run([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    *out++ = {corners[a], corners[b], corners[c]};
  });
}

}  // namespace voxdag
