#pragma once
/// Base64, RFC 4648, section 4.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Encodes bytes that arrive piece by piece.
class Base64 {
 public:
  /// Returns the text of all complete groups of three bytes.
  std::string add(std::string_view bytes);
  /// Returns the text of the rest, with its padding.
  std::string finish();

 private:
  std::uint32_t bits_ = 0;
  int count_ = 0;  // bytes in bits_
};

/// Returns the text of all bytes.
inline std::string base64(std::string_view bytes) {
  Base64 encoder;
  std::string text = encoder.add(bytes);
  return text += encoder.finish();
}

/// Returns the bytes of a text, also in the alphabet for URLs and without padding; nothing if it is
/// not base64.
std::optional<std::string> decode_base64(std::string_view text, Work work = {});

}  // namespace voxdag
