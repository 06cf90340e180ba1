#pragma once
/// Decompresses LZF (Marc Lehmann, LibLZF) as a stream.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace voxdag {

/// The bytes of a compressed text, in order. Memory: 72 KiB. Two kinds of items follow each other:
///
///     000LLLLL                     L + 1 bytes follow as they are
///     LLLDDDDD [llllllll] dddddddd  copies L + 2 bytes from D·256 + d + 1 bytes back; if L is 7,
///                                  l is added to it
class LzfStream {
 public:
  /// An item of three bytes makes at most 264 bytes.
  static constexpr std::uint64_t kMaxRatio = 88;

  /// `compressed` must stay valid.
  explicit LzfStream(std::string_view compressed);

  /// Copies the next `size` bytes to `to`. Throws Fault if there are fewer, or if the compressed
  /// text is malformed.
  void read(char* to, std::size_t size);
  void skip(std::uint64_t size);

 private:
  void decode_more();
  void decode_item();

  const char* in_;
  const char* const in_end_;
  std::vector<char> buffer_;  ///< The last bytes that items may copy, and those not yet read.
  std::size_t next_ = 0;      ///< Index of the first byte that was not read.
  std::size_t decoded_ = 0;   ///< Index behind the last decoded byte.
};

}  // namespace voxdag
