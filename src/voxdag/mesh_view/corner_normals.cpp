/// Source: Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets", Journal of
/// Graphics Tools 3(1), 1998. Weights by angle do not depend on the triangulation of faces.
#include "voxdag/mesh_view/corner_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/mesh/vertex_table.hpp"
#include "voxdag/render/camera.hpp"

namespace voxdag {
namespace {

/// The corners at each position: `corners[starts[p]]` up to `corners[starts[p + 1]]`, ascending.
struct CornersByPosition {
  std::vector<std::uint64_t> starts;
  std::vector<std::uint64_t> corners;  ///< 3 * triangle + corner of the triangle.

  std::size_t positions() const { return starts.size() - 1; }
};

/// Returns a number for each vertex; vertices at equal positions get the same number.
std::vector<std::uint32_t> position_numbers(std::span<const Vec3f> vertices) {
  std::vector<std::uint32_t> numbers(vertices.size());
  VertexTable table(vertices.size(), 2 * vertices.size() + 1);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3f plus_zero{0, 0, 0};  // -0 and +0 are equal positions
    numbers[i] = table.find_or_add(vertices[i] + plus_zero);
  }
  return numbers;
}

CornersByPosition corners_by_position(const Mesh& mesh) {
  const std::vector<std::uint32_t> position = position_numbers(mesh.vertices);
  CornersByPosition by;
  by.starts.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) ++by.starts[position[vertex] + 1];
  for (std::size_t i = 1; i < by.starts.size(); ++i) by.starts[i] += by.starts[i - 1];
  std::vector<std::uint64_t> next(by.starts.begin(), by.starts.end() - 1);
  by.corners.resize(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < by.corners.size(); ++i)
    by.corners[next[position[mesh.triangles[i / 3][i % 3]]]++] = i;
  return by;
}

/// A triangle at one of its corners.
struct Wedge {
  Vec3d normal;      ///< Unit length; zero if the triangle has no area.
  double angle = 0;  ///< Radians.
};

Wedge wedge_at(const Mesh& mesh, std::uint64_t corner) {
  const Triangle& triangle = mesh.triangles[corner / 3];
  const auto at = [&](std::uint64_t i) {  // vertex i, counted from the corner
    return static_cast<Vec3d>(mesh.vertices[triangle[(corner % 3 + i) % 3]]);
  };
  const Vec3d a = at(0), ab = at(1) - a, ac = at(2) - a;
  const Vec3d n = cross(ab, ac);
  const double area2 = length(n);
  if (!(area2 > 0)) return {};
  return {n * (1 / area2), std::atan2(area2, dot(ab, ac))};
}

}  // namespace

std::vector<std::array<PackedNormal, 3>> corner_normals(const Mesh& mesh, float crease_degrees) {
  constexpr double kRadiansPerDegree = 0.017453292519943295;
  /// If more triangles meet at a corner, as at the tip of a fan, comparing all pairs would take too
  /// long.
  constexpr std::uint64_t kMaxTriangles = 1024;
  constexpr std::size_t kBlock = 1024;
  // Slightly larger than requested, so that planes that differ by exactly the angle are smoothed in
  // spite of rounding.
  const double least_cosine = std::cos(crease_degrees * kRadiansPerDegree) - 1e-6;
  std::vector<std::array<PackedNormal, 3>> normals(mesh.triangles.size());
  const CornersByPosition by = corners_by_position(mesh);
  const std::size_t blocks = (by.positions() + kBlock - 1) / kBlock;
  parallel_for(blocks, [&](std::size_t block) {
    std::vector<Wedge> wedges;
    const std::size_t end = std::min((block + 1) * kBlock, by.positions());
    for (std::size_t p = block * kBlock; p < end; ++p) {
      const std::uint64_t first = by.starts[p], last = by.starts[p + 1];
      wedges.clear();
      for (std::uint64_t i = first; i < last; ++i) wedges.push_back(wedge_at(mesh, by.corners[i]));
      const bool is_flat = last - first > kMaxTriangles || crease_degrees <= 0;
      for (std::uint64_t i = first; i < last; ++i) {
        const Vec3d own = wedges[i - first].normal;
        if (own == Vec3d{}) continue;
        Vec3d sum = is_flat ? own : Vec3d{};
        for (const Wedge& wedge : wedges) {
          if (is_flat) break;
          const double cosine = dot(wedge.normal, own);
          if (std::fabs(cosine) >= least_cosine)
            sum = sum + wedge.normal * std::copysign(wedge.angle, cosine);
        }
        const std::uint64_t corner = by.corners[i];
        normals[corner / 3][corner % 3] = PackedNormal(static_cast<Vec3f>(normalized(sum)));
      }
    }
  });
  return normals;
}

}  // namespace voxdag
