#pragma once
/// Casts rays with voxdag, by layout.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/rays/trace_rays.hpp"
#include "bench/rays/trace_runner.hpp"
#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag {

/// The mean cost of a ray.
struct WalkCost {
  double cells = 0;  ///< Visited cells.
  double bytes = 0;  ///< Read from nodes.
};

/// Voxels in one layout, ready for casts.
class TraceLayout {
 public:
  virtual ~TraceLayout() = default;

  virtual std::uint64_t bytes() const = 0;
  /// Returns the runner on a CUDA device, if there is one.
  virtual std::optional<DeviceLayout> device_layout() const = 0;
  virtual std::uint64_t device_bytes() const { return bytes(); }
  /// Casts with the fastest caster of the layout. `casts` must outlive the runner.
  virtual TraceRunner runner(RayClass rays, std::span<const CastRay> casts) const = 0;
  virtual WalkCost cost(std::span<const CastRay> casts) const = 0;
};

/// The layouts' names, of all voxels or of these, the default first.
std::vector<std::string> trace_layouts();
std::vector<std::string> trace_layouts(const VoxelSet& voxels);

/// Throws Error where memory is short, or the layout is not one of these voxels. They must outlive
/// the result.
std::unique_ptr<TraceLayout> make_trace_layout(const std::string& name, const VoxelSet& voxels);

}  // namespace voxdag
