#pragma once
/// The device that a caller wants, and the scene in its memory.
#include <optional>

#include "voxdag/cuda/device_scene.hpp"

namespace voxdag {

struct DeviceChoice {
  enum class Kind { kCpu, kCuda, kAuto };

  Kind kind = Kind::kCpu;
  int index = -1;  ///< Of a CUDA device; -1: the first usable one.
};

/// Returns the voxels in the memory of the CUDA device; nothing if the CPU is to work, which with
/// kAuto is also so without a device or without enough memory on it. `scene` must outlive the
/// result. Throws Error if kCuda cannot be had.
std::optional<DeviceScene> load_on_device(const DeviceChoice& choice, const VoxelSet& scene,
                                          DeviceLayout layout = DeviceLayout::kPaper);

}  // namespace voxdag
