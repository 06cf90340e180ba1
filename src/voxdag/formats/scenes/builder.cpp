#include "voxdag/formats/scenes/builder.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace voxdag::scenes {

void Builder::material(std::string_view name) {
  const auto found = std::find(mesh_.materials.begin(), mesh_.materials.end(), name);
  material_ = static_cast<std::uint32_t>(found - mesh_.materials.begin());
  if (found == mesh_.materials.end()) mesh_.materials.emplace_back(name);
}

std::uint32_t Builder::vertex(Vec3d local) {
  mesh_.vertices.push_back(static_cast<Vec3f>(frame_.point(local)));
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void Builder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  work_.poll();
  const Vec3d p = static_cast<Vec3d>(mesh_.vertices[a]);
  const Vec3d n =
      cross(static_cast<Vec3d>(mesh_.vertices[b]) - p, static_cast<Vec3d>(mesh_.vertices[c]) - p);
  if (n == Vec3d{}) return;
  mesh_.triangles.push_back({a, b, c});
  mesh_.triangle_materials.push_back(material_);
}

void Builder::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void Builder::quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const std::uint32_t first = vertex(a);
  vertex(b);
  vertex(c);
  vertex(d);
  quad(first, first + 1, first + 2, first + 3);
}

void Builder::box(Vec3d lo, Vec3d hi) {
  std::uint32_t v[8];
  for (int i = 0; i < 8; ++i)
    v[i] = vertex(
        {(i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y, (i & 4) != 0 ? hi.z : lo.z});
  quad(v[0], v[4], v[6], v[2]);  // -x
  quad(v[1], v[3], v[7], v[5]);
  quad(v[0], v[1], v[5], v[4]);  // -y
  quad(v[2], v[6], v[7], v[3]);
  quad(v[0], v[2], v[3], v[1]);  // -z
  quad(v[4], v[5], v[7], v[6]);
}

void Builder::bevelled_slab(Vec3d lo, Vec3d hi, double bevel) {
  const double b = bevel;
  const auto ring = [&](double inset, double y) {
    const std::uint32_t first = vertex({lo.x + inset, y, lo.z + inset});
    vertex({lo.x + inset, y, hi.z - inset});
    vertex({hi.x - inset, y, hi.z - inset});
    vertex({hi.x - inset, y, lo.z + inset});
    return first;
  };
  const std::uint32_t rings[3] = {ring(0, lo.y), ring(0, hi.y - b), ring(b, hi.y)};
  for (int r = 0; r < 2; ++r)
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      quad(rings[r] + i, rings[r] + j, rings[r + 1] + j, rings[r + 1] + i);
    }
  quad(rings[2], rings[2] + 1, rings[2] + 2, rings[2] + 3);
}

void Builder::lathe(const Profile& profile, int sides, double phase) {
  carved_lathe(
      profile, sides, [](double, int) { return 1.0; }, phase);
}

void Builder::square(const Profile& profile) {
  const double diagonal = std::sqrt(2.0);
  carved_lathe(
      profile, 4, [&](double, int) { return diagonal; }, 0.125);
}

void Builder::moulding(const Profile& profile, double half_x, double half_z, bool outside) {
  // The signs give the direction of the path that has the chosen side of the rectangle on its
  // right.
  static constexpr int kSigns[4][2] = {{-1, -1}, {-1, 1}, {1, 1}, {1, -1}};
  const double out = outside ? 1 : -1;
  std::vector<Frame> corners;
  for (int i = 0; i < 4; ++i) {
    const int* sign = kSigns[outside ? 3 - i : i];
    corners.push_back({{sign[0] * half_x, 0, sign[1] * half_z},
                       {out * sign[0], 0, out * sign[1]},
                       {0, 1, 0},
                       {}});
  }
  sweep(profile, corners, true, false);
}

void Builder::tube(const std::vector<Vec3d>& path, const std::vector<double>& radii, int sides) {
  const std::size_t n = path.size();
  // Parallel transport: the previous normal, made perpendicular to the new tangent.
  std::vector<Vec3d> normals(n), sideways(n);
  Vec3d normal{};
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d tangent = normalized(path[std::min(i + 1, n - 1)] - path[i == 0 ? 0 : i - 1]);
    const Vec3d kept = normal - tangent * dot(normal, tangent);
    normal = i == 0 || dot(kept, kept) < 1e-12 ? perpendicular(tangent) : normalized(kept);
    normals[i] = normal;
    sideways[i] = cross(tangent, normal);
  }
  const std::size_t begin = radii.front() == 0 ? 1 : 0, end = radii.back() == 0 ? n - 1 : n;
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  const auto around = static_cast<std::uint32_t>(sides);
  for (std::size_t i = begin; i < end; ++i)
    for (int k = 0; k < sides; ++k) {
      const double t = static_cast<double>(k) / sides;
      vertex(path[i] + (normals[i] * cos_turns(t) + sideways[i] * sin_turns(t)) * radii[i]);
    }
  const auto rings = static_cast<std::uint32_t>(end - begin);
  for (std::uint32_t r = 0; r + 1 < rings; ++r)
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = first + r * around + k, b = first + r * around + (k + 1) % around;
      quad(a, b, b + around, a + around);
    }
  if (begin == 1) {
    const std::uint32_t tip = vertex(path.front());
    for (std::uint32_t k = 0; k < around; ++k) triangle(tip, first + (k + 1) % around, first + k);
  }
  if (end == n - 1) {
    const std::uint32_t tip = vertex(path.back()), last = first + (rings - 1) * around;
    for (std::uint32_t k = 0; k < around; ++k) triangle(tip, last + k, last + (k + 1) % around);
  }
}

void Builder::tube(const std::vector<Vec3d>& path, double radius, int sides) {
  tube(path, std::vector<double>(path.size(), radius), sides);
}

void Builder::sweep(const Profile& outline, const std::vector<Frame>& path, bool closed_path,
                    bool closed_outline) {
  const int points = static_cast<int>(outline.size()), stations = static_cast<int>(path.size());
  surface(closed_outline ? points : points - 1, closed_path ? stations : stations - 1,
          closed_outline, closed_path, [&](int i, int j) {
            const Point2 p = outline[i];
            return path[j].point({p.x, p.y, 0});
          });
}

void Builder::fan(const std::vector<Vec3d>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (const Vec3d& c : corners) vertex(c);
  for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) triangle(first, first + i, first + i + 1);
}

void Builder::torus(double radius, double thickness, int sides, int ring_sides) {
  surface(sides, ring_sides, true, true, [&](int i, int j) {
    const double u = -static_cast<double>(i) / sides, v = static_cast<double>(j) / ring_sides;
    const double r = radius + thickness * cos_turns(v);
    return Vec3d{r * cos_turns(u), thickness * sin_turns(v), r * sin_turns(u)};
  });
}

Profile rounded(const Profile& points, int steps) {
  Profile out;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Point2 p0 = points[i == 0 ? 0 : i - 1], p1 = points[i], p2 = points[i + 1],
                 p3 = points[std::min(i + 2, n - 1)];
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const auto spline = [t](double a, double b, double c, double d) {
        return 0.5 *
               (2 * b + t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))));
      };
      out.push_back({spline(p0.x, p1.x, p2.x, p3.x), spline(p0.y, p1.y, p2.y, p3.y)});
    }
  }
  out.push_back(points.back());
  return out;
}

}  // namespace voxdag::scenes
