#pragma once
/// The CUDA devices of this machine.
#include <cstdint>
#include <string>
#include <vector>

namespace voxdag {

struct CudaDevice {
  int index = 0;  ///< CUDA's index: the fastest first, of those in CUDA_VISIBLE_DEVICES.
  std::string name;
  int compute_capability = 0;  ///< 10 * major + minor: 75 is 7.5.
  int multiprocessors = 0;
  std::uint64_t memory_bytes = 0;
};

struct CudaDevices {
  std::vector<CudaDevice> devices;
  std::string why_none;  ///< The reason why there is no device, without a full stop.
};

/// Lists the devices. Never throws: if there is no CUDA, driver or device, why_none has the reason.
CudaDevices cuda_devices();

/// The lowest compute capability that kernels are compiled for: 75 is 7.5.
inline constexpr int kMinComputeCapability = 75;

/// Returns the device with this index, or for -1 the first that can run the kernels. Throws Error
/// ("no CUDA device: ...") if there is none.
CudaDevice choose_cuda_device(int index = -1);

}  // namespace voxdag
