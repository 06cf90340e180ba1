#pragma once
/// Takes view samples from the triangles of a mesh, for deferred shading as in Kämpe, Sintorn and
/// Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013, section 4.
#include <memory>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh_view/mesh_appearance.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

/// Finds the visible triangles with Embree and computes the points in double. They are exactly on
/// the ray, and off the triangle by at most 2^-25 of the mesh's longest side: a thousandth of a
/// voxel at 32,768³. Filters colours and normal maps over the pixel. Rays pass through alpha-masked
/// parts. Needs no voxels.
class MeshViewSource : public ViewSource {
 public:
  /// Takes ownership of the mesh and builds the acceleration structure on the threads of the
  /// current TBB arena. Throws Error if there is not enough memory, or if the library was built
  /// without Embree.
  explicit MeshViewSource(Mesh mesh, const MeshViewOptions& options = {});
  /// Also takes the appearance from the mesh's file. `warnings` is as in SurfaceShading.
  MeshViewSource(Mesh mesh, Appearance appearance, const MeshViewOptions& options,
                 std::vector<std::string>* warnings = nullptr, Work work = {});
  ~MeshViewSource() override;

  void sample(const Camera& camera, const ViewTile& tile,
              std::span<ViewSample> samples) const override;

 private:
  class Scene;
  std::unique_ptr<const Scene> scene_;
};

}  // namespace voxdag
