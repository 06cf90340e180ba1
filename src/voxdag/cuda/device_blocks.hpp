#pragma once
/// The loaded blocks of an ESVO in the memory of a CUDA device.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "voxdag/cuda/device.hpp"
#include "voxdag/stored/esvo/partial_esvo.hpp"

namespace voxdag {

/// A copy of a pool of blocks in the host's memory. Copies of this object share the device's
/// memory; the last one frees it.
class DeviceBlocks {
 public:
  /// Allocates memory for a pool of `slots` slots, a multiple of kEsvoPageSlots, of an ESVO with
  /// `blocks` blocks: 8 bytes and a bit per slot, and a byte per block. Throws Error if the device
  /// does not have enough free memory.
  DeviceBlocks(const CudaDevice& device, std::uint64_t slots, std::size_t blocks);

  const CudaDevice& device() const;
  void make_current() const;  ///< Selects the device for this thread.

  /// Copies the pool's slots in `changed`, and their marks, to the device. `pool` must have as many
  /// slots as this object. No kernel may be running.
  void update(const PartialEsvoView& pool, std::span<const SlotRange> changed);
  /// Returns the pool in the device's memory.
  const PartialEsvoView& view() const;

  /// Points to a byte per block in the device's memory, which kernels set to 1 for blocks that they
  /// need.
  std::uint8_t* wanted() const;
  /// Returns the indices of the blocks whose bytes are 1, ascending, and sets the bytes to 0. All
  /// kernels must have finished.
  std::vector<std::size_t> take_wanted() const;

 private:
  struct Memory;
  std::shared_ptr<Memory> memory_;
};

}  // namespace voxdag
