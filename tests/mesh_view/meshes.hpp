#pragma once
/// Small meshes with known surfaces.
#include <cmath>
#include <numbers>
#include <random>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns the cube [-1,1]³: twelve triangles that wind counter-clockwise seen from outside.
inline Mesh cube_mesh() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(0, 4, 6, 2);  // -x
  quad(1, 3, 7, 5);
  quad(0, 1, 5, 4);  // -y
  quad(2, 6, 7, 3);
  quad(0, 2, 3, 1);  // -z
  quad(4, 5, 7, 6);
  return mesh;
}

/// Returns the unit sphere by latitude and longitude. Every second triangle has the wrong winding.
inline Mesh disordered_sphere_mesh(int rows) {
  constexpr double kPi = std::numbers::pi;
  const int columns = 2 * rows;
  Mesh mesh;
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column) {
      const double latitude = kPi * row / rows, longitude = 2 * kPi * (column % columns) / columns;
      const double r = row == rows ? 0 : std::sin(latitude);
      mesh.vertices.push_back(
          static_cast<Vec3f>(Vec3d{r * std::cos(longitude), row == rows ? -1 : std::cos(latitude),
                                   r * std::sin(longitude)}));
    }
  const auto vertex = [&](int row, int column) {
    return static_cast<std::uint32_t>(row * (columns + 1) + column);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      mesh.triangles.push_back(
          {vertex(row, column), vertex(row + 1, column), vertex(row + 1, column + 1)});
      mesh.triangles.push_back(
          {vertex(row, column), vertex(row, column + 1), vertex(row + 1, column + 1)});
    }
  return mesh;
}

/// Returns triangles of many sizes in the cube [-1,1]³, moved by `offset`.
inline Mesh random_mesh(int triangles, std::uint64_t seed, Vec3d offset = {}) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3d{unit(random), unit(random), unit(random)}; };
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vec3d at = point() * 0.7;
    const double size = 0.3 * std::exp2(4 * unit(random) - 4);
    for (std::uint32_t corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(static_cast<Vec3f>(offset + at + point() * size));
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace voxdag
