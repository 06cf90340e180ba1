#include "voxdag/builders/esvo/shape/near_surface.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <vector>

#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// A shape near this many polygons is tested as a whole.
constexpr std::size_t kFewPolygons = 24;

constexpr int kMaxGroups = ConvexPolyhedron::kMaxVertices / kLanes + 1;

/// Points in groups of four.
struct PointGroups {
  int count = 0;
  FloatLanes x[kMaxGroups], y[kMaxGroups], z[kMaxGroups];

  /// Takes the shape's vertices and their mean.
  explicit PointGroups(const ConvexPolyhedron& shape) {
    const int vertices = shape.vertex_count();
    count = vertices / kLanes + 1;
    x[count - 1] = y[count - 1] = z[count - 1] = FloatLanes{};
    for (int i = 0; i * kLanes < vertices; ++i) {
      x[i] = load_lanes(shape.coordinates(0) + i * kLanes);
      y[i] = load_lanes(shape.coordinates(1) + i * kLanes);
      z[i] = load_lanes(shape.coordinates(2) + i * kLanes);
    }
    const Vec3f centre = shape.centre();
    const FloatLanes cx = all_lanes(centre.x), cy = all_lanes(centre.y), cz = all_lanes(centre.z);
    const IntLanes past = IntLanes{0, 1, 2, 3} >= vertices % kLanes;
    x[count - 1] = past ? cx : x[count - 1];
    y[count - 1] = past ? cy : y[count - 1];
    z[count - 1] = past ? cz : z[count - 1];
  }

  /// Scales all points by `scale` and moves them by `by`.
  void transform(float scale, Vec3f by) {
    for (int i = 0; i < count; ++i) {
      x[i] = x[i] * scale + by.x;
      y[i] = y[i] * scale + by.y;
      z[i] = z[i] * scale + by.z;
    }
  }
};

FloatLanes size_of(FloatLanes v) { return max(v, -v); }

/// The plane of a polygon.
struct Plane {
  Vec3f normal;
  float offset = 0;

  Plane() = default;
  explicit Plane(const PlanarPolygon& p)
      : normal(p.normal), offset(dot(p.normal, static_cast<Vec3f>(p.polygon->corners[0]))) {}
  FloatLanes height(const PointGroups& points, int group) const {
    return points.x[group] * normal.x + points.y[group] * normal.y + points.z[group] * normal.z -
           offset;
  }
};

/// Compares distances from a convex polygon.
class PolygonDistance {
 public:
  PolygonDistance() {}

  void set(const PlanarPolygon& p) {
    plane_ = Plane(p);
    count_ = p.polygon->count;
    for (int i = 0; i < count_; ++i) {
      Edge& edge = edges_[i];
      const int next = i + 1 == count_ ? 0 : i + 1;
      edge.from = static_cast<Vec3f>(p.polygon->corners[i]);
      edge.along = static_cast<Vec3f>(p.polygon->corners[next]) - edge.from;
      edge.inward = cross(p.normal, edge.along);
      edge.offset = dot(edge.inward, edge.from);
      const float length2 = dot(edge.along, edge.along);
      edge.per_length2 = length2 > 1e-30f ? 1 / length2 : 0.0f;
    }
    has_inside_ = count_ > 2 && p.normal != Vec3f{};
  }

  /// Returns which of the points in the mask `far` are farther away than `distance`.
  IntLanes still_far(const PointGroups& points, int group, float distance, IntLanes far) const {
    if (has_inside_) {
      IntLanes is_inside = size_of(plane_.height(points, group)) <= distance;
      for (int i = 0; i < count_; ++i) {
        const Edge& edge = edges_[i];
        is_inside &= points.x[group] * edge.inward.x + points.y[group] * edge.inward.y +
                         points.z[group] * edge.inward.z >=
                     edge.offset;
      }
      far &= ~is_inside;
    }
    for (int i = 0; i < count_ && any_lane(far); ++i) {
      const Edge& edge = edges_[i];
      const FloatLanes x = points.x[group] - edge.from.x, y = points.y[group] - edge.from.y,
                       z = points.z[group] - edge.from.z;
      const FloatLanes share =
          (x * edge.along.x + y * edge.along.y + z * edge.along.z) * edge.per_length2;
      const FloatLanes clamped = min(max(share, all_lanes(0.0f)), all_lanes(1.0f));
      const FloatLanes dx = x - clamped * edge.along.x, dy = y - clamped * edge.along.y,
                       dz = z - clamped * edge.along.z;
      far &= dx * dx + dy * dy + dz * dz > distance * distance;
    }
    return far;
  }

 private:
  struct Edge {
    Vec3f from, along;
    Vec3f inward;  ///< In the plane; inside points have at least `offset` along it.
    float offset;
    float per_length2;  ///< 1 / length² of `along`; zero for a point.
  };

  Plane plane_;
  int count_ = 0;
  bool has_inside_ = false;
  union {
    Edge edges_[SurfacePolygon::kMaxCorners];  // uninitialised
  };
};

/// Returns whether each point is within `distance` of the plane of a polygon. Most shapes that are
/// not near have a point that is too far from all planes.
bool are_near_planes(const PointGroups& points, std::span<const PlanarPolygon> surface,
                     float distance) {
  for (int i = 0; i < points.count; ++i) {
    IntLanes far = all_lanes(-1);
    for (std::size_t k = 0; k < surface.size() && any_lane(far); ++k)
      far &= size_of(Plane(surface[k]).height(points, i)) > distance;
    if (any_lane(far)) return false;
  }
  return true;
}

/// Tests a few polygons.
bool are_near_few(const PointGroups& points, std::span<const PlanarPolygon> surface,
                  float distance) {
  PolygonDistance polygons[kFewPolygons];
  std::size_t known = 0;
  for (int i = 0; i < points.count; ++i) {
    IntLanes far = all_lanes(-1);
    // Most points that are near are near a corner of a small polygon.
    for (const PlanarPolygon& polygon : surface) {
      const auto corner = static_cast<Vec3f>(polygon.polygon->corners[0]);
      const FloatLanes x = points.x[i] - corner.x, y = points.y[i] - corner.y,
                       z = points.z[i] - corner.z;
      far &= x * x + y * y + z * z > distance * distance;
    }
    for (std::size_t k = 0; k < surface.size() && any_lane(far); ++k) {
      if (k == known) polygons[known++].set(surface[k]);
      far = polygons[k].still_far(points, i, distance, far);
    }
    if (any_lane(far)) return false;
  }
  return true;
}

/// Tests many polygons. Boxes around the polygons exclude most of them at once.
class ManyPolygons {
 public:
  ManyPolygons(std::span<const PlanarPolygon> surface, float distance)
      : surface_(surface), distance_(distance) {
    boxes_.reserve(surface.size());
    for (const PlanarPolygon& p : surface) boxes_.emplace_back(*p.polygon);
  }

  /// Returns whether a shape in [-1,1]³ is near, as is_near_surface() says.
  bool has_near(const ConvexPolyhedron& shape) const {
    std::vector<std::uint32_t> all(surface_.size());
    std::iota(all.begin(), all.end(), 0u);
    return has_near(shape, {}, 1, all);
  }

 private:
  /// A box around a polygon. Lanes x, y and z are used; lane 3 is zero.
  struct Box {
    FloatLanes lo, hi;

    explicit Box(const SurfacePolygon& polygon) {
      lo = hi = lanes_of(static_cast<Vec3f>(polygon.corners[0]));
      for (int i = 1; i < polygon.count; ++i) {
        const FloatLanes corner = lanes_of(static_cast<Vec3f>(polygon.corners[i]));
        lo = min(lo, corner);
        hi = max(hi, corner);
      }
    }
    bool is_smaller_than(float size) const { return !any_lane(hi - lo >= size); }
    /// Returns which of the points are within `distance` of the box.
    IntLanes has_near(const PointGroups& points, int group, float distance) const {
      const auto away = [](FloatLanes at, float least, float most) {
        return max(max(least - at, at - most), all_lanes(0.0f));
      };
      const FloatLanes x = away(points.x[group], lo[0], hi[0]),
                       y = away(points.y[group], lo[1], hi[1]),
                       z = away(points.z[group], lo[2], hi[2]);
      return x * x + y * y + z * z <= distance * distance;
    }
    /// Returns whether the box meets the box from `from` to `to`.
    bool meets(FloatLanes from, FloatLanes to) const { return !any_lane((lo > to) | (hi < from)); }
  };

  /// Tests a part: a cube around `centre` of 2 * `half` a side. `shape` is the shape in the cube,
  /// enlarged to [-1,1]³. `polygons` are those within the distance of the cube.
  bool has_near(const ConvexPolyhedron& shape, Vec3f centre, float half,
                std::span<const std::uint32_t> polygons) const {
    if (shape.is_empty()) return true;
    PointGroups points(shape);
    points.transform(half, centre);
    if (!are_near(points, polygons)) return false;
    const auto small = std::count_if(polygons.begin(), polygons.end(), [&](std::uint32_t i) {
      return boxes_[i].is_smaller_than(2 * half);
    });
    if (static_cast<std::size_t>(small) <= kFewPolygons || half <= 2 * distance_) return true;
    const float quarter = half / 2;
    std::vector<std::uint32_t> in_octant;
    for (int child = 0; child < 8; ++child) {
      const ConvexPolyhedron octant = shape.octant(child);
      if (octant.is_empty()) continue;
      const Vec3f middle =
          centre + static_cast<Vec3f>(child_offset(child) * 2 - Vec3i{1, 1, 1}) * quarter;
      const FloatLanes reach = all_lanes(quarter + distance_), at = lanes_of(middle);
      in_octant.clear();
      std::copy_if(polygons.begin(), polygons.end(), std::back_inserter(in_octant),
                   [&](std::uint32_t i) { return boxes_[i].meets(at - reach, at + reach); });
      if (!has_near(octant, middle, quarter, in_octant)) return false;
    }
    return true;
  }

  bool are_near(const PointGroups& points, std::span<const std::uint32_t> polygons) const {
    for (int i = 0; i < points.count; ++i) {
      IntLanes far = all_lanes(-1);
      for (std::size_t k = 0; k < polygons.size() && any_lane(far); ++k) {
        const std::uint32_t index = polygons[k];
        if (!any_lane(far & boxes_[index].has_near(points, i, distance_))) continue;
        PolygonDistance polygon;
        polygon.set(surface_[index]);
        far = polygon.still_far(points, i, distance_, far);
      }
      if (any_lane(far)) return false;
    }
    return true;
  }

  std::span<const PlanarPolygon> surface_;
  float distance_;
  std::vector<Box> boxes_;
};

}  // namespace

bool is_near_surface(const ConvexPolyhedron& shape, std::span<const PlanarPolygon> surface,
                     float distance) {
  if (shape.is_empty()) return true;
  if (surface.empty() || !(distance > 0)) return false;
  const PointGroups points(shape);
  if (!are_near_planes(points, surface, distance)) return false;
  return surface.size() <= kFewPolygons ? are_near_few(points, surface, distance)
                                        : ManyPolygons(surface, distance).has_near(shape);
}

}  // namespace voxdag
