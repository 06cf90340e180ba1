#pragma once
/// The peak of this process's resident memory.
#include <cstdint>
#include <fstream>
#include <string>

namespace voxdag {

/// Resets the peak to the memory that is resident now. Returns whether the system allows it.
inline bool reset_peak() {
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << "5" << std::flush);
}

/// Returns the peak in bytes since reset_peak(); 0 if the system does not report it.
inline std::uint64_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  return 0;
}

}  // namespace voxdag
