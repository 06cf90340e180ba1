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
/// number of threads. Embree computes in float, so the vertices are moved to have the centre of
/// their bounds at the origin: rounding is by at most 2^-25 of the bounds' longest side.
class EmbreeScene {
 public:
  /// Builds on the threads of the current TBB arena. Throws Error where Embree refuses, which it
  /// does for want of memory.
  EmbreeScene(Mesh mesh, EmbreeMode mode);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  RTCScene scene() const { return scene_; }
  Vec3d center() const { return center_; }   ///< Of the bounds, world units.
  double radius() const { return radius_; }  ///< Of a sphere around it that holds the mesh.
  /// Vertices relative to center(); those of no triangle have no meaning.
  const Mesh& mesh() const { return mesh_; }

 private:
  Mesh mesh_;
  Vec3d center_{};
  double radius_ = 0;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace voxdag
