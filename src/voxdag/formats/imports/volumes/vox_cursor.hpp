#pragma once
/// Reads the numbers, strings and dictionaries of a .vox file.
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// A place in the bytes of a file, and the end that must not be passed. All functions throw Error
/// with the byte.
class VoxCursor {
 public:
  VoxCursor(const std::filesystem::path& path, std::string_view bytes)
      : path_(path), bytes_(bytes), end_(bytes.size()) {}

  std::uint64_t at() const { return at_; }
  std::uint64_t left() const { return end_ - at_; }

  [[noreturn]] void fail(const std::string& reason) const { fail_at(at_, reason); }
  [[noreturn]] void fail_at(std::uint64_t byte, const std::string& reason) const {
    throw Error(path_.string(), ErrorPlace::byte(byte), reason);
  }

  std::string_view bytes(std::uint64_t count) {
    if (count > left())
      fail("truncated: needs " + std::to_string(count) + " bytes, has " + std::to_string(left()));
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::uint32_t uint32() {
    std::uint32_t value = 0;
    for (int i = 0; const char c : bytes(4))
      value |= std::uint32_t{static_cast<unsigned char>(c)} << 8 * i++;
    return value;
  }
  std::int32_t int32() { return static_cast<std::int32_t>(uint32()); }
  /// Reads a count of items of at least `item_bytes` each, which must fit before the end.
  std::uint32_t count(std::uint64_t item_bytes, const char* items) {
    const std::uint64_t byte = at_;
    const std::uint32_t value = uint32();
    if (value > left() / item_bytes)
      fail_at(byte, "has " + std::to_string(value) + " " + items + ", more than fit");
    return value;
  }
  std::string_view string() { return bytes(count(1, "characters")); }
  /// Calls entry(key, value) for all entries of a dictionary.
  template <class Entry>
  void dictionary(const Entry& entry) {
    for (std::uint32_t i = count(8, "entries"); i > 0; --i) {
      const std::string_view key = string();
      entry(key, string());
    }
  }

  /// Returns a cursor for the next `count` bytes, and passes them.
  VoxCursor part(std::uint64_t count) {
    VoxCursor inner = *this;
    bytes(count);
    inner.end_ = at_;
    return inner;
  }

 private:
  std::filesystem::path path_;
  std::string_view bytes_;
  std::uint64_t at_ = 0, end_;
};

}  // namespace voxdag
