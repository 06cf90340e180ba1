#pragma once
/// An interface for surface points that come from something other than the voxels, as in the
/// deferred renderer of Kämpe, Sintorn and Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH
/// 2013, section 4: it shades triangles, and uses the voxels only to compute their light.
#include <span>

#include "voxdag/render/camera.hpp"
#include "voxdag/render/tile.hpp"
#include "voxdag/render/view_sample.hpp"

namespace voxdag {

/// Host only. Many threads call it concurrently.
class ViewSource {
 public:
  virtual ~ViewSource() = default;

  /// Sets samples[row * tile.width + column] to the surface that `camera` sees at that pixel's
  /// sample. The span has tile.width * tile.height values; pixels that see nothing stay
  /// ViewSample{}. Normal and face have unit length and point to the viewer's side of the surface.
  /// `point` lies exactly on it (in double: at 131,072³ a float is off by voxels). `depth` is t
  /// along camera.direction(x + dx, y + dy). cell_size stays unset: the renderer, which knows the
  /// voxels, sets it.
  virtual void sample(const Camera& camera, const ViewTile& tile,
                      std::span<ViewSample> samples) const = 0;
};

}  // namespace voxdag
