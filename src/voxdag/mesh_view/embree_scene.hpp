#pragma once
/// A mesh in Embree's hands. Only where the library was built with Embree (VOXDAG_HAS_EMBREE).
#include <embree3/rtcore.h>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

enum class EmbreeMode {
  kFast,    ///< Embree's defaults.
  kRobust,  ///< No ray slips through between two triangles of an edge; contexts may have filters.
};

/// Owns device, scene and mesh; Embree reads the mesh's own buffers. Rays may be cast from any
/// number of threads. Embree computes in float and takes no coordinates beyond 2^60, so it gets the
/// vertices in coordinates of its own: the centre of their bounds is the origin, and a power of two
/// is the unit, in which the bounds' longest side is from 1 to 2. Rounding is by at most 2^-25 of
/// that side.
class EmbreeScene {
 public:
  /// Builds on the threads of the current TBB arena. Throws Error where Embree refuses, which it
  /// does for want of memory.
  EmbreeScene(Mesh mesh, EmbreeMode mode);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  RTCScene scene() const { return scene_; }
  /// In the scene's coordinates; vertices of no triangle have no meaning.
  const Mesh& mesh() const { return mesh_; }
  double radius() const { return radius_; }  ///< Of a sphere that holds it; the same units.

  /// The scene's units in a world unit.
  double scale() const { return scale_; }
  /// A point of the world, in the scene's coordinates, and back.
  Vec3d from_world(Vec3d world) const { return (world - center_) * scale_; }
  Vec3d to_world(Vec3d point) const { return point * (1 / scale_) + center_; }

 private:
  Mesh mesh_;
  Vec3d center_{};  // of the bounds, world units
  double scale_ = 1, radius_ = 0;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace voxdag
