#pragma once
/// A CUDA device for tests that runs on the host. It behaves as badly as a real device may:
///
/// - Queues run asynchronously: work runs when the program waits for its queue, or at once if
///   `HostDevice::is_eager` is set. A missing wait, or a change of data that a queue still needs,
///   fails in one of the two modes.
/// - An access of the host to the device's memory ends the program. Arrays end exactly, to 16
/// bytes,
///   and hold noise at first.
/// - Threads of a warp run one after the other and meet where they exchange values.
/// - Any call can be made to fail.
///
/// It cannot show kernels that access the host's memory, data races between threads, or errors of
/// the device compiler.
#include <cstddef>
#include <optional>

namespace voxdag {

struct HostDevice {
  int driver_version = 13000;   ///< In CUDA's encoding; 0: no driver.
  int count = 1;                ///< Number of devices.
  int compute_capability = 90;  ///< 10 * major + minor.
  std::size_t memory_bytes = std::size_t{1} << 30;
  bool is_eager = false;
  /// The number of calls that succeed before one fails. Calls that release something never fail.
  std::optional<int> failing_call;

  // Resources that the program holds.
  std::size_t device_bytes = 0;
  int device_arrays = 0, pinned_arrays = 0, queues = 0, events = 0;
  bool holds_nothing() const {
    return device_bytes == 0 && device_arrays == 0 && pinned_arrays == 0 && queues == 0 &&
           events == 0;
  }
};

/// Returns the device of the test runtime.
HostDevice& host_device();

}  // namespace voxdag
