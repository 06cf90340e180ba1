#include "voxdag/cuda/device_choice.hpp"

#include "voxdag/core/error.hpp"

namespace voxdag {

std::optional<DeviceScene> load_on_device(const DeviceChoice& choice, const VoxelSet& scene,
                                          DeviceLayout layout) {
  if (choice.kind == DeviceChoice::Kind::kCpu) return std::nullopt;
  try {
    return DeviceScene(choose_cuda_device(choice.index), scene, layout);
  } catch (const Error&) {
    if (choice.kind == DeviceChoice::Kind::kAuto) return std::nullopt;
    throw;
  }
}

}  // namespace voxdag
