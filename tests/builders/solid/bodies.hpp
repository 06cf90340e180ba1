#pragma once
/// Closed meshes, and the winding number of their surface in double precision.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

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

}  // namespace voxdag
