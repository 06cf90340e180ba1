#pragma once
/// Embree's point queries.
#include <memory>
#include <span>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag::lab {

/// The triangles of a mesh in Embree's acceleration structure.
class EmbreeClosest {
 public:
  /// Returns whether voxdag was built with Embree.
  static bool is_available();

  /// Requires is_available().
  explicit EmbreeClosest(Mesh mesh);
  ~EmbreeClosest();

  /// Sets distances[i] to the distance from a point to the nearest triangle in world units,
  /// infinity if that is beyond `most`. Runs on all threads.
  void find(std::span<const Vec3d> points, double most, std::span<double> distances) const;

 private:
  class Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace voxdag::lab
