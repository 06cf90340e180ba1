#pragma once
/// Runs a program and measures its time and memory, for `voxdag bench`.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// The cost of a process and of the children that it waited for.
struct ProcessCost {
  double wall_seconds = 0;       ///< Time from before its start to its end.
  double user_seconds = 0;       ///< CPU time in the program, all threads together.
  double system_seconds = 0;     ///< CPU time in the kernel.
  std::uint64_t peak_bytes = 0;  ///< Peak resident memory of the largest process.

  double cpu_seconds() const { return user_seconds + system_seconds; }
};

struct ChildResult {
  int status = 0;          ///< Exit status, or 128 + the signal that ended it.
  bool timed_out = false;  ///< It was killed at its time limit.
  ProcessCost cost;
  std::string out, err;
};

/// Runs `command` (command[0] is searched in PATH) in `directory` and waits for it, for at most
/// `seconds_limit` if that is above zero. The caller should use little memory: the peak memory that
/// Linux reports includes the size of the process before exec. Throws Error if no process can be
/// created, and Cancelled, after killing the child, if `progress` is cancelled.
ChildResult run_child(const std::vector<std::string>& command,
                      const std::filesystem::path& directory, double seconds_limit,
                      const Progress& progress);

/// Returns the reason why the child failed: the first line of its errors, such as "a.obj: line 3:
/// ...", or the way in which it ended. Empty if it succeeded.
std::string failure_of(const ChildResult& result, double seconds_limit);

}  // namespace voxdag::lab
