#pragma once
/// View samples from the triangles of a mesh: the deferred input of Kämpe, Sintorn and Assarsson,
/// "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013, section 4.
#include <memory>

#include "voxdag/mesh_view/mesh_looks.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

/// Finds what pixels see with Embree and works out the point in double, from the triangle: off the
/// ray by nothing and off the triangle by at most 2^-25 of the mesh's longest side, a thousandth of
/// a voxel at 32,768³. Colours and normal maps are filtered over the pixel; what alpha cuts away is
/// looked through. Needs no voxels.
class MeshViewSource : public ViewSource {
 public:
  /// Takes the mesh over and builds what casts need, on the threads of the current TBB arena.
  /// Throws Error where the library was built without Embree, or memory is short.
  explicit MeshViewSource(Mesh mesh, const MeshViewOptions& options = {});
  /// With what the mesh's file says of its look. Warnings as of SurfaceShading.
  MeshViewSource(Mesh mesh, Appearance appearance, const MeshViewOptions& options,
                 std::vector<std::string>* warnings = nullptr, Progress* progress = nullptr);
  ~MeshViewSource() override;

  void sample(const Camera& camera, const ViewTile& tile,
              std::span<ViewSample> samples) const override;

 private:
  class Scene;
  std::unique_ptr<const Scene> scene_;
};

}  // namespace voxdag
