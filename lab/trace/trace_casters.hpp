#pragma once
/// Casts rays with voxdag's casters, one class per layout.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lab/rays/trace_rays.hpp"
#include "lab/rays/trace_runner.hpp"
#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag::lab {

/// The mean cost of a ray.
struct WalkCost {
  double cells = 0;  ///< Visited cells.
  double bytes = 0;  ///< Bytes read from nodes.
};

/// Voxels in one layout, ready for casts.
class TraceLayout {
 public:
  virtual ~TraceLayout() = default;

  virtual std::uint64_t bytes() const = 0;
  virtual DeviceLayout device_layout() const = 0;  ///< The layout on a CUDA device.
  virtual std::uint64_t device_bytes() const { return bytes(); }
  /// Returns a runner with the fastest caster of the layout. `casts` must outlive it.
  virtual TraceRunner runner(RayClass rays, std::span<const CastRay> casts) const = 0;
  virtual WalkCost cost(std::span<const CastRay> casts) const = 0;
};

/// Returns the names of the layouts, of all kinds of voxels or of these voxels; the default comes
/// first.
std::vector<std::string> trace_layouts();
std::vector<std::string> trace_layouts(const VoxelSet& voxels);

/// Makes the layout `name` for `voxels`, which must outlive it. Throws Error if there is not enough
/// memory, or if these voxels do not have this layout.
std::unique_ptr<TraceLayout> make_trace_layout(const std::string& name, const VoxelSet& voxels);

}  // namespace voxdag::lab
