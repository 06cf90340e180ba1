#pragma once
/// Counts the work of this thread, for fuzzers that bound it.
#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <ctime>

namespace voxdag {

/// Counts instructions if the processor's counters are accessible, else CPU time. Does not count
/// other threads: run the work on one thread.
class WorkCounter {
 public:
  WorkCounter() {
    perf_event_attr attributes{};
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    file_ = static_cast<int>(::syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  ~WorkCounter() {
    if (file_ >= 0) ::close(file_);
  }
  WorkCounter(const WorkCounter&) = delete;
  WorkCounter& operator=(const WorkCounter&) = delete;

  /// Returns instructions, or nanoseconds of CPU time times 3, which is about the same number.
  std::uint64_t count() const {
    std::uint64_t instructions = 0;
    if (file_ >= 0 && ::read(file_, &instructions, sizeof instructions) == sizeof instructions)
      return instructions;
    std::timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 3 * (static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000 +
                static_cast<std::uint64_t>(time.tv_nsec));
  }

 private:
  int file_ = -1;
};

}  // namespace voxdag
