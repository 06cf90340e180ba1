#pragma once
/// Where a picture's surface points come from when it is not the voxels: the deferred renderer of
/// Kämpe, Sintorn and Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013, section 4,
/// which shades triangles and asks the voxels only what light reaches them.
#include <span>

#include "voxdag/render/camera.hpp"
#include "voxdag/render/tile.hpp"
#include "voxdag/render/view_sample.hpp"

namespace voxdag {

/// Host only. Implementations are called from many threads at once.
class ViewSource {
 public:
  virtual ~ViewSource() = default;

  /// samples[row * tile.width + column] becomes what `camera` sees at that pixel's sample; there
  /// are tile.width * tile.height of them. What sees nothing stays ViewSample{}. Normal and face
  /// have unit length and lie on the viewer's side of the surface, `point` is on it exactly (in
  /// double: at 131,072³ a float is off by voxels), depth is the t of camera.direction(x + dx,
  /// y + dy). cell_size is left alone: the renderer, which knows the voxels, sets it.
  virtual void sample(const Camera& camera, const ViewTile& tile,
                      std::span<ViewSample> samples) const = 0;
};

}  // namespace voxdag
