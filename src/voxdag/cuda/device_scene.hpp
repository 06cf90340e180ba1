#pragma once
/// Voxels in the memory of a CUDA device.
#include <memory>

#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/layout/voxel_set.hpp"

namespace voxdag {

/// Shares its memory with its copies; it is freed with the last of them.
class DeviceScene {
 public:
  /// Copies the voxels; `layout` says at which layout of a DAG rays are to be cast. What `scene`
  /// points to must outlive this object, too. Throws Error where the device has not enough free
  /// memory.
  DeviceScene(const CudaDevice& device, const VoxelSet& scene,
              DeviceLayout layout = DeviceLayout::kPaper);

  const CudaDevice& device() const;
  const VoxelSet& host() const;      ///< The voxels in the host's memory.
  const DeviceVoxels& view() const;  ///< The same with pointers into the device's.
  void make_current() const;         ///< Has the calling thread work on the voxels' device.

 private:
  struct Memory;
  std::shared_ptr<const Memory> memory_;
};

}  // namespace voxdag
