#pragma once
/// A file without a name that holds sorted records.
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

class RunFile {
 public:
  /// Creates a file in `folder`. Throws Error.
  explicit RunFile(std::filesystem::path folder);

  /// Appends bytes. Throws Error and Cancelled.
  void write(const void* bytes, std::size_t count, Work work);
  /// Reads bytes that were written, from byte `offset` on. Throws Error.
  void read(void* bytes, std::size_t count, std::uint64_t offset) const;

 private:
  std::filesystem::path folder_;
  Descriptor file_;
};

}  // namespace voxdag
