#pragma once
/// Lights, as users describe them and as kernels read them.
#include <optional>

#include "voxdag/core/grid.hpp"

namespace voxdag {

enum class LightKind : std::int32_t { kSun, kPoint, kDisc, kRectangle, kSphere };

/// A light in world units. Its kind decides which fields are used.
struct LightSpec {
  LightKind kind = LightKind::kSphere;
  Vec3d position{};          ///< The centre; a rectangle's corner; the direction towards the sun.
  Vec3d normal{0, -1, 0};    ///< Disc: the side that shines. Need not have unit length.
  Vec3d edge_u{}, edge_v{};  ///< Rectangle: from its corner. It shines along edge_u × edge_v.
  double radius = 0;         ///< Disc, sphere. Sun: the tangent of its angular radius.
  /// Disc, rectangle, sphere: radiance. Point: intensity, the irradiance at distance 1. Sun: the
  /// irradiance of a surface that faces it. If not set, the light is as bright as the sun at a
  /// quarter of the grid's side.
  std::optional<Vec3f> color;
};

/// A light in units of the grid's side; the grid is [1,2]³.
struct Light {
  LightKind kind = LightKind::kSphere;
  Vec3f position{};  ///< As in LightSpec; the sun's is a unit vector.
  Vec3f u{}, v{};    ///< Disc and sun: orthogonal radii; rectangle: edges.
  Vec3f normal{};    ///< Unit length.
  float radius = 0;
  float area = 0;  ///< Disc and rectangle.
  Vec3f color{};   ///< As in LightSpec; a point's intensity is for distances in this unit.
  /// Conservative bounds on the points of the light; on its directions for the sun.
  Vec3f lowest{}, highest{};

  /// Returns whether the light casts shadows with soft edges.
  VOXDAG_HD bool is_extended() const { return kind != LightKind::kPoint && radius > 0; }
};

/// Converts a light. Throws Error for coordinates that are not finite, a missing direction, a size
/// that is not positive, and a colour that is negative or infinite.
Light make_light(const LightSpec& spec, const Grid& grid);

}  // namespace voxdag
