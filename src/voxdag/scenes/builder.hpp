#pragma once
/// Puts a mesh together from shapes. Shapes are closed or open surfaces whose outside is the side
/// of counter-clockwise triangles; triangles without area are left out.
#include <cstdint>
#include <string_view>
#include <vector>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/scenes/math.hpp"

namespace voxdag::scenes {

/// A point of a profile: distance from the axis, or sideways, and height.
struct Point2 {
  double x, y;
};
using Profile = std::vector<Point2>;

class Builder {
 public:
  /// Throws Cancelled from triangle() when `progress` is asked to stop.
  explicit Builder(const Progress* progress = nullptr) : progress_(progress) {}

  /// What follows has this material, found by name or made.
  void material(std::string_view name);
  /// What follows has its coordinates in this frame.
  void frame(const Frame& f) { frame_ = f; }
  const Frame& frame() const { return frame_; }

  /// Calls draw() with coordinates local to `f`, which is itself local to the present frame.
  template <class Draw>
  void at(const Frame& f, const Draw& draw) {
    const Frame outer = frame_;
    frame_ = outer * f;
    draw();
    frame_ = outer;
  }

  std::uint32_t vertex(Vec3d local);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Split along a-c.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  void quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

  /// The surface f(i, j), 0 <= i <= nu, 0 <= j <= nv, whose outside is that of df/di x df/dj. A
  /// closed direction has its last row joined to its first instead of a row of its own.
  template <class F>
  void surface(int nu, int nv, bool closed_u, bool closed_v, const F& f) {
    const int rows = closed_u ? nu : nu + 1, columns = closed_v ? nv : nv + 1;
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) vertex(f(i, j));
    const auto at = [&](int i, int j) {
      return first + static_cast<std::uint32_t>(i % rows * columns + j % columns);
    };
    for (int i = 0; i < nu; ++i)
      for (int j = 0; j < nv; ++j) quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }

  void box(Vec3d lo, Vec3d hi);
  /// A box whose upper edges are cut off at 45 degrees by `bevel`; no bottom.
  void bevelled_slab(Vec3d lo, Vec3d hi, double bevel);
  /// Turns a profile (radius, height), listed from bottom to top along its outside, about the y
  /// axis.
  /// The first side begins `phase` turns from the x axis.
  void lathe(const Profile& profile, int sides, double phase = 0);
  /// A square block with this profile: x is half its width.
  void square(const Profile& profile);
  /// A lathe whose radii are multiplied by f(turns, profile index).
  template <class F>
  void carved_lathe(const Profile& profile, int sides, const F& f, double phase = 0) {
    surface(sides, static_cast<int>(profile.size()) - 1, true, false, [&](int i, int j) {
      const double t = phase - static_cast<double>(i) / sides;
      const Point2 p = profile[static_cast<std::size_t>(j)];
      const double r = p.x * f(t, j);
      return Vec3d{r * cos_turns(t), p.y, r * sin_turns(t)};
    });
  }
  /// A round tube about a path with the radius at each of its points; pointed ends where the first
  /// or last radius is 0, else open ones.
  void tube(const std::vector<Vec3d>& path, const std::vector<double>& radii, int sides);
  void tube(const std::vector<Vec3d>& path, double radius, int sides);
  /// Sweeps an outline along frames. The outline runs counter-clockwise in a frame's x and y, and
  /// the path goes the way of their cross product.
  void sweep(const Profile& outline, const std::vector<Frame>& path, bool closed_path,
             bool closed_outline);
  /// Sweeps a moulding (x: how far it stands out, y: height), listed from bottom to top, along the
  /// rectangle |x| = half_x, |z| = half_z with mitred corners, on its inner or outer side.
  void moulding(const Profile& profile, double half_x, double half_z, bool outside = false);
  /// Fills a planar convex or star-shaped polygon from its first corner.
  void fan(const std::vector<Vec3d>& corners);
  void torus(double radius, double thickness, int sides, int ring_sides);
  /// Anything with a distance from the origin in each direction: a sphere of cells on a cube.
  template <class F>
  void ball(int cells, const F& radius);

  std::size_t triangle_count() const { return mesh_.triangles.size(); }
  Mesh take() { return std::move(mesh_); }

 private:
  const Progress* progress_;
  Mesh mesh_;
  Frame frame_;
  std::uint32_t material_ = 0;
};

/// Every point of a polyline replaced by a rounder run of `steps` segments (Catmull-Rom).
Profile rounded(const Profile& points, int steps);

template <class F>
void Builder::ball(int cells, const F& radius) {
  // Six faces of a cube; the corners of neighbours coincide in position.
  for (int side = 0; side < 6; ++side) {
    surface(cells, cells, false, false, [&](int i, int j) {
      const double a = 2.0 * i / cells - 1, b = 2.0 * j / cells - 1;
      const double s = side < 3 ? 1 : -1;
      const Vec3d v = side % 3 == 0   ? Vec3d{s, a, b * s}
                      : side % 3 == 1 ? Vec3d{b * s, s, a}
                                      : Vec3d{a, b * s, s};
      const Vec3d d = normalized(v);
      return d * radius(d);
    });
  }
}

}  // namespace voxdag::scenes
