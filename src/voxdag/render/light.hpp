#pragma once
/// Lights, as a person describes them and as kernels take them.
#include <optional>

#include "voxdag/core/grid.hpp"

namespace voxdag {

enum class LightKind : std::int32_t { kSun, kPoint, kDisc, kRectangle, kSphere };

/// A light in world units. Which fields count depends on its kind.
struct LightSpec {
  LightKind kind = LightKind::kSphere;
  Vec3d position{};          ///< Centre; of a rectangle a corner; of the sun the way towards it.
  Vec3d normal{0, -1, 0};    ///< Of a disc: the side that shines. Need not have unit length.
  Vec3d edge_u{}, edge_v{};  ///< Of a rectangle, from its corner; it shines along edge_u × edge_v.
  double radius = 0;         ///< Of disc and sphere. Of the sun: the tangent of its angular radius.
  /// Disc, rectangle, sphere: radiance. Point: intensity, the irradiance at distance 1. Sun: the
  /// irradiance on what faces it. Without it: as bright as the sun at a quarter of the grid's side.
  std::optional<Vec3f> color;
};

/// A light in units of the grid's side, the grid being [1,2]³.
struct Light {
  LightKind kind = LightKind::kSphere;
  Vec3f position{};  ///< As above; of the sun a unit vector.
  Vec3f u{}, v{};    ///< Disc and sun: orthogonal radii; rectangle: edges.
  Vec3f normal{};    ///< Unit length.
  float radius = 0;
  float area = 0;  ///< Of disc and rectangle.
  Vec3f color{};   ///< As above, the point's intensity with distances in this unit.
  /// Bounds of all points of the light, of the sun of its directions. A little wide.
  Vec3f lowest{}, highest{};

  /// Whether it casts shadows with soft edges.
  VOXDAG_HD bool is_extended() const { return kind != LightKind::kPoint && radius > 0; }
};

/// Throws Error for a light that cannot be: coordinates that are not finite, no direction, a size
/// that is not positive, negative or infinite light.
Light make_light(const LightSpec& spec, const Grid& grid);

}  // namespace voxdag
