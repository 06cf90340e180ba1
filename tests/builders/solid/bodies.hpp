#pragma once
/// Closed meshes, and the winding number of their surface in double precision.
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/builders/voxelize/overlap.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Adds a box whose faces look outwards, or inwards.
inline void add_box(Mesh& mesh, Vec3f lo, Vec3f hi, bool is_outward = true) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back(
        {corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z});
  constexpr std::uint32_t kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads)
    for (const auto& t : {Triangle{q[0], q[1], q[2]}, Triangle{q[0], q[2], q[3]}})
      mesh.triangles.push_back(is_outward ? Triangle{first + t[0], first + t[1], first + t[2]}
                                          : Triangle{first + t[0], first + t[2], first + t[1]});
}

/// Adds a ball of `rows` rows whose radius changes at random by up to `noise`: with much noise it
/// intersects nothing, but has deep dents.
inline void add_rough_ball(Mesh& mesh, Vec3f centre, double radius, double noise, int rows,
                           std::mt19937& rng) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const int columns = 2 * rows;
  std::uniform_real_distribution<double> change(1 - noise, 1);
  const auto add = [&](double theta, double phi) {
    const double r = radius * change(rng);
    mesh.vertices.push_back(centre + Vec3f(Vec3d{std::sin(theta) * std::cos(phi), std::cos(theta),
                                                 std::sin(theta) * std::sin(phi)} *
                                           r));
  };
  for (int row = 1; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      add(std::numbers::pi * row / rows, 2 * std::numbers::pi * column / columns);
  add(0, 0);
  add(std::numbers::pi, 0);
  const auto at = [&](int row, int column) {
    return first + static_cast<std::uint32_t>((row - 1) * columns + column % columns);
  };
  const std::uint32_t top = first + static_cast<std::uint32_t>((rows - 1) * columns),
                      bottom = top + 1;
  for (int column = 0; column < columns; ++column) {
    mesh.triangles.push_back({top, at(1, column + 1), at(1, column)});
    mesh.triangles.push_back({bottom, at(rows - 1, column), at(rows - 1, column + 1)});
    for (int row = 1; row + 1 < rows; ++row) {
      mesh.triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column)});
      mesh.triangles.push_back({at(row + 1, column), at(row, column + 1), at(row + 1, column + 1)});
    }
  }
}

/// Returns how often the surface winds around a point: the sum of the solid angles of its triangles
/// over 4 pi (Van Oosterom and Strackee 1983).
inline double winding_number(const Mesh& mesh, Vec3d point) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = static_cast<Vec3d>(mesh.vertices[t[0]]) - point,
                b = static_cast<Vec3d>(mesh.vertices[t[1]]) - point,
                c = static_cast<Vec3d>(mesh.vertices[t[2]]) - point;
    const double la = length(a), lb = length(b), lc = length(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

/// The voxels that a body only touches with faces between voxels, one voxel at a time.
class TouchedVoxels {
 public:
  /// is_inside(voxel) tells on which side the centre of a voxel lies.
  TouchedVoxels(const Mesh& mesh, const Grid& grid, std::function<bool(Vec3i)> is_inside)
      : mesh_(mesh, grid), levels_(grid.levels), is_inside_(std::move(is_inside)) {}

  bool contains(Vec3i v) const {
    if (!has_face(v) || is_body(v)) return false;
    for (int neighbour = 1; neighbour < 8; ++neighbour)
      if (is_body(v - child_offset(neighbour))) return true;
    return false;
  }

 private:
  /// Returns whether a triangle meets the voxel, as a cube without its upper sides or without its
  /// lower ones.
  bool is_met(Vec3i v, bool has_upper_sides) const {
    for (std::size_t i = 0; i < mesh_.triangle_count(); ++i) {
      const QuantizedTriangle t = mesh_.triangle(i);
      const Vec3l low = static_cast<Vec3l>(v) * std::int64_t{256};
      if (has_upper_sides
              ? triangle_overlaps_cube(-t.x, -t.y, -t.z, -low - Vec3l{256, 256, 256}, 256)
              : triangle_overlaps_cube(t.x, t.y, t.z, low, 256))
        return true;
    }
    return false;
  }
  bool has_face(Vec3i v) const {
    for (std::size_t i = 0; i < mesh_.triangle_count(); ++i) {
      const QuantizedTriangle t = mesh_.triangle(i);
      const auto is_in_plane = [&](int axis) {
        return t.x[axis] % 256 == 0 && t.x[axis] == t.y[axis] && t.x[axis] == t.z[axis];
      };
      if ((is_in_plane(0) || is_in_plane(1) || is_in_plane(2)) &&
          triangle_overlaps_cube(t.x, t.y, t.z, static_cast<Vec3l>(v) * std::int64_t{256}, 256))
        return true;
    }
    return false;
  }
  bool is_body(Vec3i v) const {
    for (int axis = 0; axis < 3; ++axis)
      if (v[axis] < 0 || v[axis] >> levels_ != 0) return false;
    const bool is_below = is_met(v, false), is_above = is_met(v, true);
    return (is_below && is_above) || is_inside_(v);
  }

  QuantizedMesh mesh_;
  int levels_;
  std::function<bool(Vec3i)> is_inside_;
};

}  // namespace voxdag
