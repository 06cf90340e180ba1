#pragma once
/// Bounds the memory of a reader that goes through a mapped file once.
#include <cstddef>

#include "voxdag/core/io/mapped_file.hpp"

namespace voxdag {

/// Drops the pages behind the reader from memory, a MiB at a time.
class PassedPages {
 public:
  /// `from` points into the file; the reader starts there.
  PassedPages(const MappedFile& file, const char* from) : file_(file), from_(from) {}

  /// The reader needs nothing before `at` any more.
  void pass(const char* at) {
    const auto passed = static_cast<std::size_t>(at - from_);
    if (passed < kStep) return;
    file_.release({from_, passed});
    from_ = at;
  }

 private:
  static constexpr std::size_t kStep = std::size_t{1} << 20;

  const MappedFile& file_;
  const char* from_;
};

}  // namespace voxdag
