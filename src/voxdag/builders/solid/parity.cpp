#include "voxdag/builders/solid/parity.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

#include "voxdag/builders/solid/ray_bins.hpp"
#include "voxdag/core/int128.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

constexpr std::int32_t kUnits = 256;  // of a voxel, in each direction

Vec3l centre_of(Vec3i voxel) {
  const auto at = [](std::int32_t v) { return std::int64_t{v} * kUnits + kUnits / 2; };
  return {at(voxel.x), at(voxel.y), at(voxel.z)};
}

template <class T>
int sign_of(T value) {
  return (value > 0) - (value < 0);
}

/// Returns on which side of the line from a to b the ray at p passes in the plane of y and z: 1 or
/// -1; 0 if a and b have the same y and z.
int side_of_edge(const Vec3l& a, const Vec3l& b, const Vec3l& p) {
  const std::int64_t dy = b.y - a.y, dz = b.z - a.z;
  const int side = sign_of(dy * (p.z - a.z) - dz * (p.y - a.y));
  if (side != 0) return side;
  // The ray is at (p.y + e, p.z + e²) for an infinitely small e.
  return dz != 0 ? -sign_of(dz) : sign_of(dy);
}

/// Returns whether the ray from p along +x crosses the triangle. A point in the triangle lies
/// beside it, as the ray does, and by an infinitely smaller step along x.
bool crosses(const std::array<Vec3l, 3>& t, const Vec3l& p) {
  const int side = side_of_edge(t[0], t[1], p);
  if (side == 0 || side_of_edge(t[1], t[2], p) != side || side_of_edge(t[2], t[0], p) != side)
    return false;
  const Vec3l u = t[1] - t[0], v = t[2] - t[0], to_p = p - t[0];
  const Vec3l normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const Int128 above = static_cast<Int128>(normal.x) * to_p.x +
                       static_cast<Int128>(normal.y) * to_p.y +
                       static_cast<Int128>(normal.z) * to_p.z;
  const int side_of_plane = above != 0      ? sign_of(above)
                            : normal.y != 0 ? sign_of(normal.y)
                            : normal.z != 0 ? sign_of(normal.z)
                                            : sign_of(normal.x);
  return side_of_plane * sign_of(normal.x) < 0;
}

}  // namespace

std::vector<bool> are_inside(const QuantizedMesh& mesh, const std::vector<Vec3i>& voxels,
                             Work work) {
  if (voxels.empty()) return {};
  const RayBins bins(voxels, nullptr);
  std::vector<std::uint8_t> odd(voxels.size(), 0);
  constexpr std::size_t kChunk = 1024;
  const std::size_t count = mesh.triangle_count();
  polled_for((count + kChunk - 1) / kChunk, 1, work, "inside", [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      if (!mesh.in_range(i)) continue;
      const QuantizedTriangle triangle = mesh.triangle(i);
      const std::array<Vec3l, 3> corners = {static_cast<Vec3l>(triangle.x),
                                            static_cast<Vec3l>(triangle.y),
                                            static_cast<Vec3l>(triangle.z)};
      bins.each_behind(triangle, [&](std::uint32_t place) {
        if (crosses(corners, centre_of(voxels[place])))
          std::atomic_ref(odd[place]).fetch_xor(1, std::memory_order_relaxed);
      });
    }
  });
  return {odd.begin(), odd.end()};
}

}  // namespace voxdag
