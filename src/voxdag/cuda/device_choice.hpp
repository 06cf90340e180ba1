#pragma once
/// The choice between CPU and CUDA device, and the scene in the device's memory.
#include <optional>

#include "voxdag/cuda/device_scene.hpp"

namespace voxdag {

struct DeviceChoice {
  enum class Kind { kCpu, kCuda, kAuto };

  Kind kind = Kind::kCpu;
  int index = -1;  ///< Index of a CUDA device; -1: the first usable one.
};

/// Copies the voxels to the memory of the CUDA device. Returns nothing if the CPU is used: by
/// choice, or with kAuto if there is no device or not enough memory on it. `scene` must outlive the
/// result, and `layout` must be one for it. Throws Error if kCuda was asked for and cannot be used.
std::optional<DeviceScene> load_on_device(const DeviceChoice& choice, const VoxelSet& scene,
                                          DeviceLayout layout);

}  // namespace voxdag
