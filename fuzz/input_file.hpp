#pragma once
/// A file that holds the input of a run.
#include <cstdint>

#include "support/temp_dir.hpp"

namespace voxdag {

/// Writes the input to the file of this process, for readers that take paths. TMPDIR=/dev/shm keeps
/// it in memory.
inline std::filesystem::path input_file(const std::uint8_t* data, std::size_t size) {
  static const TempDir folder;
  const std::filesystem::path path = folder / "input";
  write_text(path, {reinterpret_cast<const char*>(data), size});
  return path;
}

}  // namespace voxdag
