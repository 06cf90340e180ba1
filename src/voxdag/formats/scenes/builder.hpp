#pragma once
/// Assembles a mesh from shapes. Shapes are closed or open surfaces. Their outside is the side on
/// which triangles wind counter-clockwise. Triangles without area are dropped.
#include <cstdint>
#include <string_view>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/scenes/math.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag::scenes {

/// A point of a profile: x is the distance from the axis or wall, y the height.
struct Point2 {
  double x, y;
};
using Profile = std::vector<Point2>;

class Builder {
 public:
  /// If `work` is cancelled, triangle() throws Cancelled.
  explicit Builder(Work work = {}) : work_(work) {}

  /// Sets the material of the next triangles, by name; adds a new name to the mesh.
  void material(std::string_view name);
  /// Sets the frame of the next coordinates.
  void frame(const Frame& f) { frame_ = f; }
  const Frame& frame() const { return frame_; }

  /// Calls draw() with coordinates local to `f`; `f` is local to the current frame.
  template <class Draw>
  void at(const Frame& f, const Draw& draw) {
    const Frame outer = frame_;
    frame_ = outer * f;
    draw();
    frame_ = outer;
  }

  std::uint32_t vertex(Vec3d local);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Adds two triangles, split along a-c.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  void quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

  /// Adds the surface f(i, j), 0 <= i <= nu, 0 <= j <= nv; df/di x df/dj points outside. In a
  /// closed direction the last row equals the first one.
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
  /// Adds a box without a bottom, whose upper edges are cut at 45 degrees by `bevel`.
  void bevelled_slab(Vec3d lo, Vec3d hi, double bevel);
  /// Adds the surface of revolution of a profile (radius, height) about the y axis. The profile
  /// goes from bottom to top along its outside. The first side begins `phase` turns from the x
  /// axis.
  void lathe(const Profile& profile, int sides, double phase = 0);
  /// Adds a square block with this profile; x is half its width.
  void square(const Profile& profile);
  /// Adds a lathe whose radii are multiplied by f(turns, profile index).
  template <class F>
  void carved_lathe(const Profile& profile, int sides, const F& f, double phase = 0) {
    surface(sides, static_cast<int>(profile.size()) - 1, true, false, [&](int i, int j) {
      const double t = phase - static_cast<double>(i) / sides;
      const Point2 p = profile[j];
      const double r = p.x * f(t, j);
      return Vec3d{r * cos_turns(t), p.y, r * sin_turns(t)};
    });
  }
  /// Adds a round tube along a path, with a radius per point. An end is pointed if its radius is 0,
  /// else open.
  void tube(const std::vector<Vec3d>& path, const std::vector<double>& radii, int sides);
  void tube(const std::vector<Vec3d>& path, double radius, int sides);
  /// Sweeps an outline along frames. The outline runs counter-clockwise in the x and y of a frame;
  /// the path runs along their cross product.
  void sweep(const Profile& outline, const std::vector<Frame>& path, bool closed_path,
             bool closed_outline);
  /// Sweeps a moulding along the rectangle |x| = half_x, |z| = half_z with mitred corners, on its
  /// inner or outer side. The profile goes from bottom to top; x is the distance from the wall.
  void moulding(const Profile& profile, double half_x, double half_z, bool outside = false);
  /// Fills a planar convex or star-shaped polygon from its first corner.
  void fan(const std::vector<Vec3d>& corners);
  void torus(double radius, double thickness, int sides, int ring_sides);
  /// Adds the surface at distance radius(direction) from the origin: a cube of cells x cells quads
  /// per side, projected to a sphere.
  template <class F>
  void ball(int cells, const F& radius);

  std::size_t triangle_count() const { return mesh_.triangles.size(); }
  Mesh take() { return std::move(mesh_); }

 private:
  Work work_;
  Mesh mesh_;
  Frame frame_;
  std::uint32_t material_ = 0;
};

/// Returns the polyline as a Catmull-Rom curve with `steps` segments per segment of `points`.
Profile rounded(const Profile& points, int steps);

template <class F>
void Builder::ball(int cells, const F& radius) {
  // Six faces of a cube. Neighbouring faces have equal positions along their edge.
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
