#include "voxdag/cuda/device.hpp"

#include <cuda_runtime_api.h>

namespace voxdag {
namespace {

/// Formats a CUDA version, which is 1000 * major + 10 * minor.
std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

std::string why_none(cudaError_t status) {
  int driver = 0;
  cudaDriverGetVersion(&driver);
  switch (status) {
    case cudaErrorInsufficientDriver:
      if (driver == 0) return "no NVIDIA driver is installed";
      return "the NVIDIA driver supports CUDA " + version_text(driver) + ", but voxdag needs " +
             version_text(CUDART_VERSION) + " or later";
    case cudaErrorNoDevice:
      return "the NVIDIA driver finds no device";
    default:
      return cudaGetErrorString(status);
  }
}

}  // namespace

CudaDevices cuda_devices() {
  CudaDevices found;
  int count = 0;
  if (const cudaError_t status = cudaGetDeviceCount(&count); status != cudaSuccess) {
    cudaGetLastError();  // clears the error
    found.why_none = why_none(status);
    return found;
  }
  if (count == 0) found.why_none = why_none(cudaErrorNoDevice);
  for (int index = 0; index < count; ++index) {
    cudaDeviceProp properties{};
    if (const cudaError_t status = cudaGetDeviceProperties(&properties, index);
        status != cudaSuccess) {
      cudaGetLastError();
      found.devices.clear();
      found.why_none = why_none(status);
      return found;
    }
    CudaDevice device;
    device.index = index;
    device.name = properties.name;
    device.compute_capability = 10 * properties.major + properties.minor;
    device.multiprocessors = properties.multiProcessorCount;
    device.memory_bytes = properties.totalGlobalMem;
    found.devices.push_back(device);
  }
  return found;
}

}  // namespace voxdag
