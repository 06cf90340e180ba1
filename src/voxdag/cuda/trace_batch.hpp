#pragma once
/// Casts batches of rays on a CUDA device.
#include <memory>
#include <span>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/trace/hit.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// Casts rays from host memory in blocks. While the device traces one block, the hits of the
/// previous block are copied to the host and the rays of the next block to the device. Not
/// thread-safe.
class CudaTracer {
 public:
  /// `grid.levels` must be the DAG's. Throws Error if there is not enough memory.
  CudaTracer(const DeviceScene& dag, const Grid& grid);

  /// Sets hits[i] to the first voxel of the DAG along rays[i], which is in world units. The hits
  /// equal those of trace_batch() on the CPU, to the bit. The spans must have equal length. Throws
  /// Cancelled, and Error if the device fails.
  void trace(std::span<const Ray> rays, std::span<Hit> hits, Work work = {}) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace voxdag
