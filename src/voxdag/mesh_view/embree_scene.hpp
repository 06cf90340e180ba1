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
/// rays. Embree computes in float and accepts no coordinates beyond 2^60. So the scene has its own
/// coordinates. Their origin is the centre of the vertices' bounds. Their unit is the power of two
/// for which the bounds' longest side is from 1 to 2. Rounding moves vertices by at most 2^-25 of
/// that side.
class EmbreeScene {
 public:
  /// Builds on the threads of the current TBB arena. Throws Error if Embree fails, for example
  /// because there is not enough memory.
  EmbreeScene(Mesh mesh, EmbreeMode mode);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  RTCScene scene() const { return scene_; }
  /// Returns the mesh in the scene's coordinates. Vertices that no triangle uses are undefined.
  const Mesh& mesh() const { return mesh_; }
  double radius() const {
    return radius_;
  }  ///< Radius of a sphere around the mesh, in scene units.

  /// Returns the number of scene units per world unit.
  double scale() const { return scale_; }
  /// Converts a point from world coordinates to scene coordinates.
  Vec3d from_world(Vec3d world) const { return (world - center_) * scale_; }
  Vec3d to_world(Vec3d point) const { return point * (1 / scale_) + center_; }

 private:
  Mesh mesh_;
  Vec3d center_{};  // centre of the bounds, world units
  double scale_ = 1, radius_ = 0;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace voxdag
