#include "voxdag/formats/exports/faces/manifold_faces.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace voxdag {
namespace {

constexpr double kMove = 0.125;  ///< Voxels.

/// Sets `label` to a number for each connected part of the cells of `mask` in 2³ cells. Neighbours
/// differ in at most `most` coordinates.
void label_parts(unsigned mask, int most, std::array<int, 8>& label) {
  label.fill(-1);
  for (int first = 0; first < 8; ++first) {
    if ((mask >> first & 1) == 0 || label[first] >= 0) continue;
    label[first] = first;
    for (bool grows = true; grows;) {
      grows = false;
      for (int a = 0; a < 8; ++a)
        for (int b = 0; b < 8; ++b)
          if (label[a] == first && (mask >> b & 1) != 0 && label[b] < 0 &&
              std::popcount(static_cast<unsigned>(a ^ b)) <= most) {
            label[b] = first;
            grows = true;
          }
    }
  }
}

/// Where the corner of a face goes: moves[cell][axis] is for the face of voxel `cell` of the 2³
/// around the corner, across `axis`.
using CornerMoves = std::array<std::array<Vec3d, 3>, 8>;

/// Finds the fans of faces around a corner: each lies between a connected part of the voxels and a
/// part of the empty cells, which are also connected over edges. If there are several, each moves
/// against the sum of its normals.
CornerMoves corner_moves(unsigned voxels) {
  std::array<int, 8> part, gap;
  label_parts(voxels, 1, part);
  label_parts(~voxels & 0xFF, 2, gap);
  struct Fan {
    Vec3d normals;  ///< The sum, into the voxels. It is never zero.
    int faces = 0;
  };
  std::array<std::array<Fan, 8>, 8> all{};
  int fans = 0;
  const auto for_each_face = [&](const auto& fn) {
    for (int cell = 0; cell < 8; ++cell)
      for (int axis = 0; axis < 3; ++axis) {
        const int beside = cell ^ 1 << axis;
        if (part[cell] >= 0 && gap[beside] >= 0) fn(cell, axis, all[part[cell]][gap[beside]]);
      }
  };
  for_each_face([&](int cell, int axis, Fan& fan) {
    fans += fan.faces++ == 0 ? 1 : 0;
    fan.normals[axis] += (cell >> axis & 1) != 0 ? 1 : -1;
  });
  CornerMoves moves{};
  if (fans > 1)
    for_each_face([&](int cell, int axis, const Fan& fan) {
      moves[cell][axis] = fan.normals * (kMove / std::sqrt(dot(fan.normals, fan.normals)));
    });
  return moves;
}

/// The voxels of a leaf block and those around it.
class Neighbourhood {
 public:
  Neighbourhood(const VoxelSet& voxels, const Box3i& window, Vec3i origin, std::uint64_t block) {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const Vec3i by{4 * x, 4 * y, 4 * z}, at = origin + by;
          std::uint64_t mask =
              by == Vec3i{} ? block : voxels.leaf_block_at(at) & leaf_window_mask(at, window);
          for (; mask != 0; mask &= mask - 1)
            set(by + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask))));
        }
  }

  /// Coordinates are -1 to 4, from the block's origin.
  bool has(Vec3i v) const { return cells_[index(v)]; }
  /// Returns the mask of the 2³ voxels around a corner.
  unsigned around(Vec3i corner) const {
    unsigned mask = 0;
    for (int i = 0; i < 8; ++i)
      mask |= (has(corner + Vec3i{i & 1, i >> 1 & 1, i >> 2} - Vec3i{1, 1, 1}) ? 1u : 0u) << i;
    return mask;
  }

 private:
  static std::size_t index(Vec3i v) {
    return static_cast<std::size_t>(v.x + 1 + 6 * (v.y + 1 + 6 * (v.z + 1)));
  }
  void set(Vec3i v) {
    if (std::min({v.x, v.y, v.z}) >= -1 && std::max({v.x, v.y, v.z}) <= 4) cells_[index(v)] = true;
  }
  std::array<bool, 6 * 6 * 6> cells_{};
};

/// Sets the polygon of the face of voxel `v` of a block.
void set_manifold_face(const std::array<CornerMoves, 256>& moves, const Neighbourhood& near,
                       Vec3i origin, Vec3i v, Face face, FacePolygon& polygon) {
  const int axis = face_axis(face);
  FaceRectangle square{face, v, v + Vec3i{1, 1, 1}, {}};
  square.lo[axis] = square.hi[axis] = v[axis] + (static_cast<int>(face) & 1);
  const std::array<Vec3i, 4> corners = corners_of(square);
  polygon.face = face;
  polygon.corners.clear();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3i corner = corners[i], next = corners[(i + 1) % 4];
    const Vec3i cell = v - corner + Vec3i{1, 1, 1};
    const int index = cell.x | cell.y << 1 | cell.z << 2;
    polygon.corners.push_back(Vec3d(origin + corner) + moves[near.around(corner)][index][axis]);
    // The edge to the next corner has four faces if only the voxel across it is set.
    const Vec3d middle = (Vec3d(corner) + Vec3d(next)) * 0.5;
    const Vec3d inward = Vec3d(v) + Vec3d{0.5, 0.5, 0.5} - middle;  // Across the edge.
    const Vec3i across = v - Vec3i(inward * 2.0);
    Vec3i beside = across;
    beside[axis] = v[axis];
    if (near.has(across) && !near.has(beside))
      polygon.corners.push_back(Vec3d(origin) + middle +
                                inward * (kMove / std::sqrt(dot(inward, inward))));
  }
  if (polygon.corners.size() == 4) {
    polygon.triangles = {{0, 1, 2}, {0, 2, 3}};
    return;
  }
  const auto count = static_cast<std::uint32_t>(polygon.corners.size());
  polygon.corners.push_back((Vec3d(square.lo) + Vec3d(square.hi)) * 0.5 + Vec3d(origin));
  polygon.triangles.clear();
  for (std::uint32_t i = 0; i < count; ++i)
    polygon.triangles.push_back({count, i, (i + 1) % count});
}

}  // namespace

void for_each_manifold_face(const VoxelSet& voxels, const Box3i& window, LookReader* colors,
                            const std::function<void(std::uint64_t)>& progress,
                            const std::function<void(const FacePolygon&)>& fn) {
  static const auto moves = [] {
    std::array<CornerMoves, 256> all;
    for (unsigned mask = 0; mask < 256; ++mask) all[mask] = corner_moves(mask);
    return all;
  }();
  FacePolygon polygon;
  std::uint64_t done = 0, blocks = 0;
  voxels.for_each_leaf_block(window, [&](Vec3i origin, std::uint64_t block) {
    const Neighbourhood near(voxels, window, origin, block);
    for (std::uint64_t left = block; left != 0; left &= left - 1) {
      const Vec3i v = morton_decode(static_cast<std::uint64_t>(std::countr_zero(left)));
      bool is_colored = false;
      for (int i = 0; i < 6; ++i) {
        const auto face = static_cast<Face>(i);
        if (near.has(v + face_normal(face))) continue;
        if (colors != nullptr && !std::exchange(is_colored, true))
          polygon.color = colors->read(origin + v, voxels.levels()).color;
        set_manifold_face(moves, near, origin, v, face, polygon);
        fn(polygon);
      }
    }
    done += static_cast<std::uint64_t>(popcount64(block));
    if (++blocks % 4096 == 0) progress(done);
  });
}

}  // namespace voxdag
