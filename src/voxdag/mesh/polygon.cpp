/// Ear clipping (G. H. Meisters, "Polygons have ears", 1975): a corner whose triangle contains no
/// other corner is an ear. Ears are cut off until one triangle is left. Only reflex corners can lie
/// in another corner's triangle, and a k-d tree finds them. A corner that is not an ear can become
/// one only when a neighbour is cut off, so each cut needs two tests.
///
/// Corners at one position share one point of the tree. It is present while any of them is reflex
/// and not cut off. So repeated positions cost no extra time.
#include "voxdag/mesh/polygon.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/mesh/point_tree.hpp"

namespace voxdag {
namespace {

using Point = PlanePoint;

/// The number of visited nodes of the tree between two polls of cancellation.
constexpr std::uint64_t kVisitsPerPoll = std::uint64_t{1} << 20;

/// Returns the maximum number of tree nodes to visit for a polygon of `corners` corners. Stars,
/// combs and spirals of 100,000 corners need less than a fifth of that.
std::uint64_t max_visits(std::size_t corners) {
  return std::uint64_t{128} * corners * static_cast<std::uint64_t>(std::bit_width(corners));
}

/// Returns twice the area of a triangle in space, as a vector along its normal.
Vec3d area_vector(const Triangle& triangle, std::span<const Vec3f> vertices) {
  const Vec3d a(vertices[triangle[0]]), b(vertices[triangle[1]]), c(vertices[triangle[2]]);
  return cross(b - a, c - a);
}

class EarClipper {
 public:
  /// `points` are the corners of a polygon that is counter-clockwise (it has a positive area).
  /// `poll` may be empty.
  EarClipper(const std::vector<Point>& points, const std::function<void()>& poll)
      : points_(points),
        poll_(poll),
        max_visits_(max_visits(points.size())),
        next_(points.size()),
        previous_(points.size()),
        is_waiting_(points.size(), false),
        left_(points.size()),
        position_(points.size(), kNoPosition),
        is_blocking_(points.size(), false),
        tree_(link()),
        blocking_(points.size(), 0) {
    for (std::uint32_t i = 0; i < points.size(); ++i) update(i);
  }

  /// Calls on_triangle(a, b, c) with indices of corners. There are two triangles less than corners.
  template <class OnTriangle>
  void run(const OnTriangle& on_triangle) {
    std::vector<std::uint32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0u);
    clip(all, Ear::kClear, on_triangle);
    // The remaining polygon crosses itself, or touches itself at other points than corners.
    for (const Ear least : {Ear::kTouched, Ear::kConvex, Ear::kAny})
      for (const std::uint32_t corner : all) clip({corner}, least, on_triangle);
  }

 private:
  static constexpr std::uint32_t kNoPosition = ~0u;

  /// Conditions for cutting a corner off, from the strictest to none.
  enum class Ear {
    kClear,    ///< Convex, and no other corner lies in its triangle or on its edges.
    kTouched,  ///< Convex, and no other corner lies inside its triangle.
    kConvex,
    kAny
  };

  /// Links the corners to a ring. Returns the distinct positions of the corners that are not
  /// convex, and sets `position_` of those corners.
  std::vector<Point> link() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = i + 1 == count ? 0 : i + 1;
      previous_[next_[i]] = i;
    }
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < count; ++i)
      if (corner_area(i) <= 0) reflex.push_back(i);
    std::sort(reflex.begin(), reflex.end(), [&](std::uint32_t i, std::uint32_t j) {
      const Point a = points_[i], b = points_[j];
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : i < j;
    });
    std::vector<Point> positions;
    for (const std::uint32_t i : reflex) {
      if (positions.empty() || positions.back() != points_[i]) positions.push_back(points_[i]);
      position_[i] = static_cast<std::uint32_t>(positions.size()) - 1;
    }
    return positions;
  }

  double corner_area(std::uint32_t i) const {
    return signed_area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }
  bool is_cut(std::uint32_t i) const { return next_[i] == i; }

  /// Updates the tree: is corner `i` reflex now? A corner that was convex at first is never reflex.
  void update(std::uint32_t i) {
    const std::uint32_t position = position_[i];
    if (position == kNoPosition) return;
    const bool is_blocking = !is_cut(i) && !(corner_area(i) > 0);
    if (is_blocking == is_blocking_[i]) return;
    is_blocking_[i] = is_blocking;
    blocking_[position] += is_blocking ? 1u : ~0u;
    tree_.set_present(position, blocking_[position] != 0);
  }

  bool is_ear(std::uint32_t i, Ear least) {
    if (least == Ear::kAny) return true;
    const double size = corner_area(i);
    if (size <= 0 || least == Ear::kConvex) return size >= 0;  // An area of 0 holds no corner.
    const Point a = points_[previous_[i]], b = points_[i], c = points_[next_[i]];
    const bool is_blocked = tree_.any_in(a, b, c, visits_, [&](Point p) {
      // Polygons with holes have several corners at one position.
      if (p == a || p == b || p == c) return false;
      return least == Ear::kClear ||
             (signed_area(a, b, p) > 0 && signed_area(b, c, p) > 0 && signed_area(c, a, p) > 0);
    });
    bound_work();
    return !is_blocked;
  }

  void bound_work() {
    if (visits_ > max_visits_)
      throw Error("a polygon of " + std::to_string(points_.size()) +
                  " corners is too complex to be divided into triangles");
    if (visits_ < next_poll_) return;
    next_poll_ = visits_ + kVisitsPerPoll;
    if (poll_) poll_();
  }

  /// Cuts off the ears among `corners`, then those among their neighbours, and so on. Neighbours
  /// wait for the next round, which avoids thin triangles.
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
        for (const std::uint32_t changed : {i, before, after}) update(changed);
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
  const std::function<void()>& poll_;
  const std::uint64_t max_visits_;
  std::uint64_t visits_ = 0, next_poll_ = kVisitsPerPoll;
  std::vector<std::uint32_t> next_, previous_;  ///< A cut-off corner is its own next.
  std::vector<bool> is_waiting_;
  std::size_t left_;
  std::vector<std::uint32_t> position_;  ///< Each corner's point in the tree, or kNoPosition.
  std::vector<bool> is_blocking_;        ///< Per corner: reflex and not cut off.
  PointTree tree_;
  std::vector<std::uint32_t> blocking_;  ///< Number of blocking corners of each point in the tree.
};

/// Projects the corners of a polygon along its unit normal. The result is counter-clockwise.
std::vector<Point> project(std::span<const std::uint32_t> corners, std::span<const Vec3f> vertices,
                           Vec3d normal) {
  // Uses the axis after the normal's longest component. It is far from parallel to the normal, and
  // for a normal along an axis the projection is exact.
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

void cut_polygon(std::span<Triangle> fan, std::span<const Vec3f> vertices,
                 const std::function<void()>& poll) {
  if (fan.size() < 2) return;
  Vec3d normal;  // M. Newell's normal: the sum of the area vectors, equal for all fans of
                 // a polygon.
  for (const Triangle& triangle : fan) normal = normal + area_vector(triangle, vertices);
  normal = normalized_or(normal, {});
  if (normal == Vec3d{}) return;
  if (std::all_of(fan.begin(), fan.end(), [&](const Triangle& triangle) {
        return dot(area_vector(triangle, vertices), normal) >= 0;
      }))
    return;

  std::vector<std::uint32_t> corners{fan[0][0], fan[0][1]};
  corners.reserve(fan.size() + 2);
  for (const Triangle& triangle : fan) corners.push_back(triangle[2]);
  const std::vector<Point> points = project(corners, vertices, normal);
  auto out = fan.begin();
  EarClipper(points, poll).run([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    *out++ = {corners[a], corners[b], corners[c]};
  });
}

}  // namespace voxdag
