#pragma once
/// Batches of rays on a CUDA device.
#include <memory>
#include <span>

#include "voxdag/core/grid.hpp"
#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/trace/hit.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// Casts rays from host memory in blocks. While the device traces one block, it copies the hits of
/// the last block back and the rays of the next one there. Not thread-safe.
class CudaTracer {
 public:
  /// `grid.levels` must be the DAG's. Throws Error if memory is short.
  CudaTracer(const DeviceScene& dag, const Grid& grid);

  /// Sets hits[i] to the first voxel of the DAG along rays[i], which is in world units: the same,
  /// to the bit, as trace_batch() on the CPU. The spans must have equal length. Throws Cancelled,
  /// and Error if the device fails.
  void trace(std::span<const Ray> rays, std::span<Hit> hits, Progress* progress = nullptr) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace voxdag
