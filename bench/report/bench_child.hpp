#pragma once
/// Runs another program and says what it took: how every figure of `voxdag bench` is measured.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// What a process and the children that it waited for took.
struct ProcessCost {
  double wall_seconds = 0;       ///< From before it was started until it had ended.
  double user_seconds = 0;       ///< CPU time in the program, all threads together.
  double system_seconds = 0;     ///< CPU time in the kernel.
  std::uint64_t peak_bytes = 0;  ///< Largest resident set, of the largest process.

  double cpu_seconds() const { return user_seconds + system_seconds; }
};

struct ChildResult {
  int status = 0;          ///< Exit status, or 128 + the signal that ended it.
  bool timed_out = false;  ///< It was ended for taking longer than was allowed.
  ProcessCost cost;
  std::string out, err;
};

/// Runs `command` (command[0] is searched in PATH) in `directory` and waits for it, at most
/// `seconds_limit` where that is above zero. It is a process of its own, so that the peak memory is
/// its own; keep the caller small, because Linux counts what a process was before exec as well.
/// Throws Error if no process can be made, and Cancelled, after ending the child, if `progress` was
/// cancelled.
ChildResult run_child(const std::vector<std::string>& command,
                      const std::filesystem::path& directory, double seconds_limit,
                      const Progress& progress);

/// Returns why the child failed: the first line of its errors, such as "a.obj: line 3: ...", or how
/// it ended. Empty if it succeeded.
std::string failure_of(const ChildResult& result, double seconds_limit);

}  // namespace voxdag
