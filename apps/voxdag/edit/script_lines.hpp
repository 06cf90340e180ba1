#pragma once
/// Reads a text line by line, from a file or a pipe of any length.
#include <cstdint>
#include <string>
#include <string_view>

#include "voxdag/core/io/descriptor.hpp"

namespace voxdag::cli {

class ScriptLines {
 public:
  /// Opens a file; "-" is the standard input. Throws Error with the file's name.
  explicit ScriptLines(const std::string& file);

  /// Sets `line` to the next line, without its "\n"; it is valid until the next call. Returns false
  /// at the end. Throws Error if the file cannot be read or a line has more than 256 MiB.
  bool next(std::string_view& line);
  /// Returns the number of the last line, from 1 on.
  std::uint64_t number() const { return number_; }

 private:
  /// Appends bytes to the buffer. Returns false at the end.
  bool read_more();

  std::string file_, buffer_;
  Descriptor input_;
  std::size_t start_ = 0;  ///< Of the next line in the buffer.
  std::uint64_t number_ = 0;
};

}  // namespace voxdag::cli
