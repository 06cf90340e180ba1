#pragma once
/// Embree 3: casts voxdag's rays at the triangles of the mesh.
#include <memory>

#include "lab/rivals/rival.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag::lab {

/// Its casts are "embree_single" (one ray at a time) and "embree_packet16" (packets of 16
/// consecutive rays, once with the flag for coherent rays and once with the flag for incoherent
/// rays).
class EmbreeRival : public Rival {
 public:
  /// Returns whether voxdag was built with Embree.
  static bool is_available();

  /// Requires is_available().
  explicit EmbreeRival(Mesh mesh);
  ~EmbreeRival() override;

  std::vector<TraceRunner> prepare(const Grid& grid, const RaySet& set) override;

 private:
  class Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace voxdag::lab
