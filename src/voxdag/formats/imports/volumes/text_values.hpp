#pragma once
/// Numbers that are written as text.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "voxdag/formats/imports/volumes/value_type.hpp"

namespace voxdag {

/// Reads numbers from a byte of a file to its end. All functions throw Error with the byte.
class TextValues {
 public:
  /// The text must outlive this.
  TextValues(std::filesystem::path path, std::string_view text, std::uint64_t begin)
      : path_(std::move(path)), text_(text), at_(begin) {}

  /// Fills the span with numbers of a type, in the byte order of the machine. They are decimal and
  /// stand between white space or commas.
  void fill_decimal(ValueType type, std::span<std::byte> bytes);
  /// Fills the span with bytes of two hexadecimal digits each.
  void fill_hex(std::span<std::byte> bytes);
  /// Throws if there is more than white space.
  void expect_end();

 private:
  void skip_spaces();
  [[noreturn]] void fail(const std::string& reason) const;

  std::filesystem::path path_;
  std::string_view text_;
  std::uint64_t at_;
};

}  // namespace voxdag
