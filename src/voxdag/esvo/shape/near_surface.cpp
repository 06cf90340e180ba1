#include "voxdag/esvo/shape/near_surface.hpp"

#include <algorithm>

namespace voxdag {
namespace {

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

}  // namespace

bool is_near_surface(const ConvexPolyhedron& shape, std::span<const PlanarPolygon> surface,
                     float distance) {
  if (shape.is_empty()) return true;
  if (surface.empty() || surface.size() > kMostNearPolygons || !(distance > 0)) return false;
  const PointGroups points(shape);
  // Most shapes that are not near have a point that is too far from all planes.
  for (int i = 0; i < points.count; ++i) {
    IntLanes far = all_lanes(-1);
    for (const PlanarPolygon& polygon : surface)
      far &= size_of(Plane(polygon).height(points, i)) > distance;
    if (any_lane(far)) return false;
  }
  PolygonDistance polygons[kMostNearPolygons];
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

}  // namespace voxdag
