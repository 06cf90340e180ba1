#include "voxdag/formats/imports/volumes/text_values.hpp"

#include <charconv>
#include <cstring>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

bool separates(char c) { return c == ' ' || c == ',' || (c >= '\t' && c <= '\r'); }

}  // namespace

void TextValues::fill_decimal(ValueType type, std::span<std::byte> bytes) {
  with_type(type, [&]<class T>(T zero) {
    // No format has texts of these.
    if constexpr (std::is_same_v<T, Half>)
      fail("has a type that is not written as text");
    else
      for (std::size_t i = 0; i < bytes.size(); i += sizeof zero) {
        skip_spaces();
        if (at_ < text_.size() && text_[at_] == '+') ++at_;
        const char* const begin = text_.data() + at_;
        const char* const end = text_.data() + text_.size();
        auto value = zero;
        const auto [next, error] = std::from_chars(begin, end, value);
        if (begin == end) fail("truncated: the volume has more values than the file");
        if (error != std::errc() || (next != end && !separates(*next)))
          fail("is not a number of the volume's type");
        at_ += static_cast<std::uint64_t>(next - begin);
        std::memcpy(bytes.data() + i, &value, sizeof value);
      }
  });
}

void TextValues::fill_hex(std::span<std::byte> bytes) {
  for (std::byte& byte : bytes) {
    skip_spaces();
    std::uint8_t value = 0;
    const std::string_view digits = text_.substr(at_, 2);
    const char* const end = digits.data() + digits.size();
    if (digits.size() < 2) fail("truncated: the volume has more values than the file");
    const auto [next, error] = std::from_chars(digits.data(), end, value, 16);
    if (error != std::errc() || next != end) fail("is not a byte of two hexadecimal digits");
    at_ += 2;
    byte = static_cast<std::byte>(value);
  }
}

void TextValues::expect_end() {
  skip_spaces();
  if (at_ < text_.size()) fail("has more values than the volume");
}

void TextValues::skip_spaces() {
  while (at_ < text_.size() && separates(text_[at_])) ++at_;
}

void TextValues::fail(const std::string& reason) const {
  throw Error(path_.string(), ErrorPlace::byte(at_), reason);
}

}  // namespace voxdag
