#pragma once
/// A DAG in the memory of a CUDA device.
#include <memory>

#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/device_dag.hpp"

namespace voxdag {

/// Shares its memory with its copies; it is freed with the last of them.
class DeviceSvdag {
 public:
  /// Copies the DAG, for rays to be cast at this layout of it. What `dag` points to must outlive
  /// this object, too. Throws Error where the device has not enough free memory.
  DeviceSvdag(const CudaDevice& device, const SvdagView& dag,
              DeviceLayout layout = DeviceLayout::kPaper);

  const CudaDevice& device() const;
  const SvdagView& host() const;  ///< The DAG in the host's memory.
  const DeviceDag& view() const;  ///< The same with pointers into the device's.
  void make_current() const;      ///< Has the calling thread work on the DAG's device.

 private:
  struct Memory;
  std::shared_ptr<const Memory> memory_;
};

}  // namespace voxdag
