#pragma once
/// A file without a name that holds sorted records.
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag {

class RunFile {
 public:
  /// Creates a file in `folder`. Throws Error.
  explicit RunFile(std::filesystem::path folder);

  /// Appends bytes. Throws Error and Cancelled; `progress` may be null.
  void write(const void* bytes, std::size_t count, const Progress* progress);
  /// Reads bytes that were written, from byte `offset` on. Throws Error.
  void read(void* bytes, std::size_t count, std::uint64_t offset) const;

 private:
  std::filesystem::path folder_;
  Descriptor file_;
};

}  // namespace voxdag
