#pragma once
/// The CUDA devices of this machine.
#include <cstdint>
#include <string>
#include <vector>

namespace voxdag {

struct CudaDevice {
  int index = 0;  ///< As CUDA counts them: the fastest first, of those in CUDA_VISIBLE_DEVICES.
  std::string name;
  int compute_capability = 0;  ///< 10 * major + minor: 75 is 7.5.
  int multiprocessors = 0;
  std::uint64_t memory_bytes = 0;
};

struct CudaDevices {
  std::vector<CudaDevice> devices;
  std::string why_none;  ///< Why there is no device, where there is none: half a sentence.
};

/// Never throws: a build without CUDA, a machine without driver or device are reasons.
CudaDevices cuda_devices();

/// The least compute capability that kernels are compiled for.
inline constexpr int kLeastComputeCapability = 75;

/// The device with this index, or for -1 the first that can run the kernels. Throws Error: "no CUDA
/// device: ...".
CudaDevice choose_cuda_device(int index = -1);

}  // namespace voxdag
