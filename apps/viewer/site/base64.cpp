#include "viewer/site/base64.hpp"

namespace voxdag {
namespace {

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

char digit(std::uint32_t bits, int at) { return kDigits[bits >> at & 63]; }

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

}  // namespace voxdag
