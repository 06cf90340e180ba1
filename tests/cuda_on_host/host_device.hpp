#pragma once
/// A CUDA device for tests, on the host. It behaves as badly as a device may:
///
/// - Work in a queue is done when somebody waits for the queue and not before, or at once, as
///   `HostDevice::is_eager` says: what misses a wait, or changes what a queue still needs, fails
///   with one of them.
/// - The host cannot touch the memory of the device: that ends the program. Arrays end
///   where they were said to, to 16 bytes, and hold noise at first.
/// - Threads of a warp run one after the other and meet where they exchange values.
/// - Any call can be made to fail.
///
/// What it cannot show: memory of the host that a kernel touches, data races between threads, and
/// what the compiler for devices makes of the kernels.
#include <cstddef>
#include <optional>

namespace voxdag {

struct HostDevice {
  int driver_version = 13000;   ///< As CUDA counts; 0 where there is none.
  int count = 1;                ///< Of devices.
  int compute_capability = 90;  ///< 10 * major + minor.
  std::size_t memory_bytes = std::size_t{1} << 30;
  bool is_eager = false;
  /// So many more calls succeed, and then one fails. Those that give something back never do.
  std::optional<int> failing_call;

  // What the program holds.
  std::size_t device_bytes = 0;
  int device_arrays = 0, pinned_arrays = 0, queues = 0, events = 0;
  bool holds_nothing() const {
    return device_bytes == 0 && device_arrays == 0 && pinned_arrays == 0 && queues == 0 &&
           events == 0;
  }
};

/// The one that the runtime acts for.
HostDevice& host_device();

}  // namespace voxdag
