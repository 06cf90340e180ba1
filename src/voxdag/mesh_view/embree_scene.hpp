#pragma once
/// A mesh in Embree's acceleration structure. Needs Embree (VOXDAG_HAS_EMBREE).
#include <embree3/rtcore.h>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

enum class EmbreeMode {
  kFast,    ///< Embree's defaults.
  kRobust,  ///< No ray slips through an edge between two triangles; contexts may have filters.
};

/// Owns device, scene and mesh; Embree reads the mesh's buffers. Any number of threads may cast
/// rays. Embree computes in float and takes no coordinates beyond 2^60. Therefore the scene has
/// coordinates of its own: the origin is the centre of the vertices' bounds, and the unit is the
/// power of two in which the bounds' longest side is from 1 to 2. Rounding moves vertices by at
/// most 2^-25 of that side.
class EmbreeScene {
 public:
  /// Builds on the threads of the current TBB arena. Throws Error if Embree fails, which happens
  /// when memory is short.
  EmbreeScene(Mesh mesh, EmbreeMode mode);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  RTCScene scene() const { return scene_; }
  /// Has the scene's coordinates; vertices that no triangle uses are undefined.
  const Mesh& mesh() const { return mesh_; }
  double radius() const { return radius_; }  ///< Of a sphere around the mesh, in the scene's units.

  /// The scene's units per world unit.
  double scale() const { return scale_; }
  /// Convert points between the world's and the scene's coordinates.
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
