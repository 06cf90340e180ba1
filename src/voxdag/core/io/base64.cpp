#include "voxdag/core/io/base64.hpp"

namespace voxdag {
namespace {

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

char digit(std::uint32_t bits, int at) { return kDigits[bits >> at & 63]; }

/// Returns the value of a digit, also of the URL-safe alphabet, or -1.
int value_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

}  // namespace

std::string Base64::add(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (const char byte : bytes) {
    bits_ = bits_ << 8 | static_cast<unsigned char>(byte);
    if (++count_ < 3) continue;
    for (const int at : {18, 12, 6, 0}) text += digit(bits_, at);
    bits_ = 0;
    count_ = 0;
  }
  return text;
}

std::string Base64::finish() {
  std::string text;
  if (count_ == 1) text = {digit(bits_ << 16, 18), digit(bits_ << 16, 12), '=', '='};
  if (count_ == 2) text = {digit(bits_ << 8, 18), digit(bits_ << 8, 12), digit(bits_ << 8, 6), '='};
  bits_ = 0;
  count_ = 0;
  return text;
}

std::optional<std::string> decode_base64(std::string_view text, Work work) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i % 65536 == 0) work.poll();
    const int digit = value_of(text[i]);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      out += static_cast<char>(bits >> count & 0xFF);
    }
  }
  return out;
}

}  // namespace voxdag
