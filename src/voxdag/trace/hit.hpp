#pragma once
/// The result of a ray cast.
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The side of a voxel through which a ray enters it, named by its outward normal.
enum class Face : std::int8_t {
  kNone = -1,  ///< The ray starts inside the voxel.
  kNegativeX,
  kPositiveX,
  kNegativeY,
  kPositiveY,
  kNegativeZ,
  kPositiveZ,
};

/// Returns 0, 1 or 2 for x, y or z; the face must not be kNone.
VOXDAG_HD constexpr int face_axis(Face face) { return static_cast<int>(face) >> 1; }

/// Returns the outward normal, or zero for kNone.
VOXDAG_HD constexpr Vec3i face_normal(Face face) {
  Vec3i normal{};
  if (face != Face::kNone) normal[face_axis(face)] = (static_cast<int>(face) & 1) != 0 ? 1 : -1;
  return normal;
}

/// The first cell along a ray. If there is none, all fields have their default values.
struct Hit {
  float t = 0;              ///< In units of the ray's direction; t_min if the ray starts inside.
  Vec3i voxel{};            ///< The voxel, or the lowest voxel of a coarser cell.
  Face face = Face::kNone;  ///< The face through which the ray enters the cell.
  std::int8_t level =
      0;  ///< L for a voxel, less if the level of detail ended the cast at a coarser cell.
  bool hit = false;

  friend bool operator==(const Hit&, const Hit&) = default;
};

}  // namespace voxdag
