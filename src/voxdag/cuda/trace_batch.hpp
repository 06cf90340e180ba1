#pragma once
/// Many rays at once: batch visibility queries on a CUDA device.
#include <memory>
#include <span>

#include "voxdag/core/grid.hpp"
#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/trace/hit.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// Casts rays from host memory in blocks; while one is traced, the one before is copied back and
/// the next one there. Not for several threads at once.
class CudaTracer {
 public:
  /// `grid.levels` is the DAG's. Throws Error where memory is short.
  CudaTracer(const DeviceScene& dag, const Grid& grid);

  /// hits[i] becomes the first voxel of the DAG along rays[i], which is in world units: to the bit
  /// what trace_batch() finds on the CPU. The spans have equal length. Throws Cancelled, and Error
  /// where the device fails.
  void trace(std::span<const Ray> rays, std::span<Hit> hits, Progress* progress = nullptr) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace voxdag
