#include "voxdag/formats/exports/faces/manifold_faces.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace voxdag {
namespace {

constexpr double kMove = 0.125;  ///< Voxels.
/// The farthest that a smooth corner moves along an axis, in voxels: as far as those of a single
/// voxel in one round. So corners of the lattice never meet, and thin parts keep a body.
constexpr double kFarthestMove = 1.0 / 3;

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

/// The fans of faces around a corner of the lattice. The face of voxel `cell` of the 2³ around the
/// corner, across `axis`, has the index [cell][axis].
struct CornerFans {
  template <class T>
  using OfFaces = std::array<std::array<T, 3>, 8>;
  int count = 0;
  OfFaces<std::uint8_t> faces{};  ///< The number of faces in the fan.
  OfFaces<Vec3d> apart{};         ///< Where the corner goes, if there are several fans.
  OfFaces<Vec3d> smooth{};        ///< The mean of the middles of the fan's faces.
};

/// Returns the step from a corner along an axis that lies along the face of `cell`.
Vec3i step_along(int cell, int axis) {
  Vec3i step{};
  step[axis] = (cell >> axis & 1) != 0 ? 1 : -1;
  return step;
}

/// Calls fn(cell, axis) for the faces between a voxel of `mask` and an empty cell.
template <class Fn>
void for_each_face_of(unsigned mask, const Fn& fn) {
  for (int cell = 0; cell < 8; ++cell)
    for (int axis = 0; axis < 3; ++axis)
      if ((mask >> cell & 1) != 0 && (mask >> (cell ^ 1 << axis) & 1) == 0) fn(cell, axis);
}

/// Finds the fans of faces around a corner: each lies between a connected part of the voxels and a
/// part of the empty cells, which are also connected over edges. If there are several, each moves
/// against the sum of its normals.
CornerFans fans_around(unsigned voxels) {
  std::array<int, 8> part, gap;
  label_parts(voxels, 1, part);
  label_parts(~voxels & 0xFF, 2, gap);
  struct Fan {
    Vec3d normals;  ///< The sum, into the voxels. It is never zero.
    Vec3d middles;  ///< The sum, from the corner.
    int faces = 0;
  };
  std::array<std::array<Fan, 8>, 8> all{};
  const auto fan_of = [&](int cell, int axis) -> Fan& {
    return all[part[cell]][gap[cell ^ 1 << axis]];
  };
  CornerFans fans;
  for_each_face_of(voxels, [&](int cell, int axis) {
    Fan& fan = fan_of(cell, axis);
    fans.count += fan.faces++ == 0 ? 1 : 0;
    fan.normals = fan.normals + Vec3d(step_along(cell, axis));
    for (const int along : {(axis + 1) % 3, (axis + 2) % 3})
      fan.middles = fan.middles + Vec3d(step_along(cell, along)) * 0.5;
  });
  for_each_face_of(voxels, [&](int cell, int axis) {
    const Fan& fan = fan_of(cell, axis);
    fans.faces[cell][axis] = static_cast<std::uint8_t>(fan.faces);
    fans.smooth[cell][axis] = fan.middles * (1.0 / fan.faces);
    if (fans.count > 1)
      fans.apart[cell][axis] = fan.normals * (kMove / std::sqrt(dot(fan.normals, fan.normals)));
  });
  return fans;
}

const CornerFans& fans_of(unsigned mask) {
  static const auto all = [] {
    std::array<CornerFans, 256> fans;
    for (unsigned i = 0; i < 256; ++i) fans[i] = fans_around(i);
    return fans;
  }();
  return all[mask];
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

  /// Coordinates are -2 to 5, from the block's origin.
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
    return static_cast<std::size_t>(v.x + 2 + 8 * (v.y + 2 + 8 * (v.z + 2)));
  }
  void set(Vec3i v) {
    if (std::min({v.x, v.y, v.z}) >= -2 && std::max({v.x, v.y, v.z}) <= 5) cells_[index(v)] = true;
  }
  std::array<bool, 8 * 8 * 8> cells_{};
};

/// Returns where a corner of a smooth face goes. A corner of one fan moves twice to the mean of the
/// middles of its faces; their corners move once before the second time.
Vec3d smooth_move(const Neighbourhood& near, Vec3i corner, int cell, int axis) {
  const unsigned mask = near.around(corner);
  const CornerFans& fans = fans_of(mask);
  if (fans.count > 1) return fans.smooth[cell][axis];  // They must not meet.
  Vec3d sum{};
  for_each_face_of(mask, [&](int of, int across) {
    const int u = (across + 1) % 3, v = (across + 2) % 3;
    for (int i = 0; i < 4; ++i) {
      const int by_u = i & 1, by_v = i >> 1;
      const Vec3i step = step_along(of, u) * by_u + step_along(of, v) * by_v;
      const int there = of ^ by_u << u ^ by_v << v;
      sum = sum + Vec3d(step) + fans_of(near.around(corner + step)).smooth[there][across];
    }
  });
  const Vec3d mean = sum * (0.25 / fans.faces[cell][axis]);
  return max(min(mean, Vec3d{kFarthestMove, kFarthestMove, kFarthestMove}),
             Vec3d{-kFarthestMove, -kFarthestMove, -kFarthestMove});
}

/// Cuts a polygon, whose centre is its last corner if it has more than four, into triangles.
void set_triangles(FacePolygon& polygon) {
  const std::vector<Vec3d>& p = polygon.corners;
  if (p.size() == 4) {  // Along the shorter diagonal.
    const Vec3d first = p[2] - p[0], second = p[3] - p[1];
    if (dot(second, second) < dot(first, first))
      polygon.triangles = {{0, 1, 3}, {1, 2, 3}};
    else
      polygon.triangles = {{0, 1, 2}, {0, 2, 3}};
    return;
  }
  const auto count = static_cast<std::uint32_t>(p.size() - 1);
  polygon.triangles.clear();
  for (std::uint32_t i = 0; i < count; ++i)
    polygon.triangles.push_back({count, i, (i + 1) % count});
}

/// Sets the polygon of the face of voxel `v` of a block.
void set_manifold_face(const Neighbourhood& near, Vec3i origin, Vec3i v, Face face, bool smooth,
                       FacePolygon& polygon) {
  const int axis = face_axis(face);
  FaceRectangle square{face, v, v + Vec3i{1, 1, 1}, {}};
  square.lo[axis] = square.hi[axis] = v[axis] + (static_cast<int>(face) & 1);
  const std::array<Vec3i, 4> corners = corners_of(square);
  std::array<Vec3d, 4> bases, places;  // Before and after fans come apart.
  std::array<std::uint8_t, 4> faces;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3i cell = v - corners[i] + Vec3i{1, 1, 1};
    const int index = cell.x | cell.y << 1 | cell.z << 2;
    const CornerFans& fans = fans_of(near.around(corners[i]));
    faces[i] = fans.faces[index][axis];
    bases[i] = Vec3d(origin + corners[i]);
    if (smooth) bases[i] = bases[i] + smooth_move(near, corners[i], index, axis);
    places[i] = smooth ? bases[i] : bases[i] + fans.apart[index][axis];
  }
  polygon.face = face;
  polygon.voxel = origin + v;
  polygon.corners.clear();
  polygon.uses.clear();
  const auto add = [&](Vec3d place, std::uint8_t uses) {
    polygon.corners.push_back(place);
    polygon.uses.push_back(uses);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    add(places[i], faces[i]);
    // The edge to the next corner has four faces if only the voxel across it is set.
    const std::size_t next = (i + 1) % 4;
    const Vec3d edge = (Vec3d(corners[i]) + Vec3d(corners[next])) * 0.5;
    const Vec3d inward = Vec3d(v) + Vec3d{0.5, 0.5, 0.5} - edge;  // Across the edge.
    const Vec3i across = v - Vec3i(inward * 2.0);
    Vec3i beside = across;
    beside[axis] = v[axis];
    if (near.has(across) && !near.has(beside))
      add((bases[i] + bases[next]) * 0.5 + inward * (kMove / std::sqrt(dot(inward, inward))), 2);
  }
  if (polygon.corners.size() > 4) add((bases[0] + bases[1] + bases[2] + bases[3]) * 0.25, 1);
  set_triangles(polygon);
}

}  // namespace

void for_each_manifold_face(const VoxelSet& voxels, const Box3i& window, LookReader* colors,
                            const std::function<void(std::uint64_t)>& progress,
                            const std::function<void(const FacePolygon&)>& fn, bool smooth) {
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
        set_manifold_face(near, origin, v, face, smooth, polygon);
        fn(polygon);
      }
    }
    done += static_cast<std::uint64_t>(popcount64(block));
    if (++blocks % 4096 == 0) progress(done);
  });
}

}  // namespace voxdag
