#include "voxdag/cuda/device_choice.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/cuda/device.hpp"

namespace voxdag {

namespace {

std::string capability_text(int capability) {
  return std::to_string(capability / 10) + "." + std::to_string(capability % 10);
}

}  // namespace

CudaDevice choose_cuda_device(int index) {
  const CudaDevices found = cuda_devices();
  if (found.devices.empty()) throw Error("no CUDA device: " + found.why_none);
  if (index >= static_cast<int>(found.devices.size()))
    throw Error("no CUDA device " + std::to_string(index) + ": the driver lists " +
                std::to_string(found.devices.size()) + ", numbered from 0");
  for (const CudaDevice& device : found.devices)
    if ((index < 0 || device.index == index) && device.compute_capability >= kMinComputeCapability)
      return device;
  const CudaDevice& device = found.devices[index < 0 ? 0 : index];
  throw Error("no CUDA device: " + device.name + " has compute capability " +
              capability_text(device.compute_capability) + ", but voxdag needs " +
              capability_text(kMinComputeCapability) + " or later");
}

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
