#pragma once
/// Channels: named numbers of cells, by number, up to 16 for each cell, such as an intensity, a
/// temperature or a roughness.
///
/// They are stored as one array of 64-bit words, which is also the chunk CHAN of a file:
///
///   byte 0   ChannelsHeader   64 bytes
///   64       ChannelEntry     128 bytes for each channel
///   ...      the words of channel 0, of channel 1, ...
///
/// The words of a channel are a ChannelBlock for each 256 values with consecutive numbers, then the
/// packed values of block 0, of block 1, ... Each block begins at a word. Its value i is the number
/// of ChannelBlock::width bits that begins at its bit i * width, plus ChannelBlock::minimum: a
/// *code* if the channel is lossless or the block exact, else a multiple of twice the bound.
///
/// The code of a whole number is the number itself; that of a float is its bits, in an order that
/// follows the order of floats (code_of_float()).
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/stored/svdag/bit_words.hpp"

namespace voxdag {

inline constexpr std::uint32_t kMaxChannels = 16;
inline constexpr std::uint64_t kChannelBlockValues = 256;

enum class ChannelKind : std::uint32_t { kU8, kU16, kI16, kI32, kF32 };
inline constexpr std::uint32_t kChannelKinds = 5;

/// Returns what `use` returns for a zero of the kind's type.
template <class Use>
decltype(auto) with_kind(ChannelKind kind, const Use& use) {
  switch (kind) {
    case ChannelKind::kU8:
      return use(std::uint8_t{});
    case ChannelKind::kU16:
      return use(std::uint16_t{});
    case ChannelKind::kI16:
      return use(std::int16_t{});
    case ChannelKind::kI32:
      return use(std::int32_t{});
    case ChannelKind::kF32:
      break;
  }
  return use(float{});
}

struct ChannelsHeader {
  std::uint32_t channels;    ///< 1 to kMaxChannels.
  std::uint32_t reserved;    ///< Zero.
  std::uint64_t values;      ///< Of each channel: the cells of the DAG.
  std::uint64_t padding[6];  ///< Zero.
};
static_assert(sizeof(ChannelsHeader) == 64);

struct ChannelEntry {
  char name[64];             ///< See is_channel_name(); zeros follow. Names differ.
  std::uint32_t kind;        ///< ChannelKind.
  std::uint32_t reserved;    ///< Zero.
  double bound;              ///< The largest error of a value; 0: lossless. Only floats have one.
  std::uint64_t words;       ///< Words of the channel.
  std::uint64_t padding[5];  ///< Zero.
};
static_assert(sizeof(ChannelEntry) == 128 && offsetof(ChannelEntry, bound) == 72);

/// Describes 256 values; the last block of a channel may have fewer.
struct ChannelBlock {
  static constexpr std::uint64_t kWords = 2;
  static constexpr int kMaxWidth = 32;

  std::uint64_t begin = 0;   ///< First word of its packed values, counted after the blocks.
  std::int32_t minimum = 0;  ///< The least of its numbers.
  int width = 0;             ///< Bits of a packed value, 0 to 32.
  bool is_exact = false;     ///< With a bound: whether the numbers are codes all the same.

  /// Bits of the second word: 0 to 31 minimum, 32 to 37 width, 38 is_exact.
  VOXDAG_HD static ChannelBlock unpack(const std::uint64_t* words) {
    return {words[0], static_cast<std::int32_t>(words[1]), static_cast<int>(words[1] >> 32 & 63),
            (words[1] >> 38 & 1) != 0};
  }
  void pack(std::uint64_t* words) const {
    words[0] = begin;
    words[1] = static_cast<std::uint32_t>(minimum) | static_cast<std::uint64_t>(width) << 32 |
               std::uint64_t{is_exact} << 38;
  }
  /// Returns the words of `values` packed values.
  static std::uint64_t words_of(std::uint64_t values, int width) {
    return (values * static_cast<std::uint64_t>(width) + 63) / 64;
  }
};

/// Returns the code of a float: of two floats, the smaller one has the smaller code, and -0 the
/// code -1.
inline std::int32_t code_of_float(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  return bits < 0 ? bits ^ 0x7FFFFFFF : bits;
}
inline float float_of_code(std::int32_t code) {
  return std::bit_cast<float>(code < 0 ? code ^ 0x7FFFFFFF : code);
}
/// The code of the largest finite float. Those of all finite floats are from -kMaxFloatCode - 1 on.
inline constexpr std::int32_t kMaxFloatCode = 0x7F7FFFFF;

/// A view of one channel.
struct ChannelView {
  ChannelKind kind = ChannelKind::kU8;
  double bound = 0;                      ///< 0: lossless.
  const std::uint64_t* words = nullptr;  ///< The blocks, then the packed values.
  std::uint64_t values = 0, word_count = 0;
  const char* stored_name = nullptr;

  std::uint64_t block_count() const {
    return (values + kChannelBlockValues - 1) / kChannelBlockValues;
  }
  ChannelBlock block(std::uint64_t i) const {
    return ChannelBlock::unpack(words + ChannelBlock::kWords * i);
  }
  /// Returns the value for which a number of a block stands.
  double value_of(const ChannelBlock& block, std::int32_t number) const {
    if (kind != ChannelKind::kF32) return number;
    if (bound == 0 || block.is_exact) return static_cast<double>(float_of_code(number));
    return static_cast<double>(static_cast<float>(number * (2 * bound)));
  }
  /// Returns the value `i` of a block.
  double read(const ChannelBlock& block, std::uint64_t i) const {
    const std::uint64_t* const packed = words + ChannelBlock::kWords * block_count() + block.begin;
    const std::uint64_t above =
        read_bits(packed, i * static_cast<std::uint64_t>(block.width), block.width);
    return value_of(block, static_cast<std::int32_t>(static_cast<std::uint32_t>(block.minimum) +
                                                     static_cast<std::uint32_t>(above)));
  }
  /// Returns the value of the cell with number `number`, less than `values`. It is one of the
  /// numbers that `kind` has.
  double read(std::uint64_t number) const {
    return read(block(number / kChannelBlockValues), number % kChannelBlockValues);
  }
  std::string_view name() const { return stored_name; }
};

/// A view of all channels.
struct ChannelsView {
  const std::uint64_t* words = nullptr;  ///< As in the chunk CHAN; null: there are none.

  VOXDAG_HD bool is_empty() const { return words == nullptr; }
  const ChannelsHeader& header() const { return *reinterpret_cast<const ChannelsHeader*>(words); }
  const ChannelEntry& entry(std::size_t i) const {
    return *reinterpret_cast<const ChannelEntry*>(words + 8 + 16 * i);
  }
  std::size_t count() const { return is_empty() ? 0 : header().channels; }
  /// Returns the channel `i`, less than count().
  ChannelView operator[](std::size_t i) const {
    const std::uint64_t* at = words + 8 + 16 * count();
    for (std::size_t before = 0; before < i; ++before) at += entry(before).words;
    const ChannelEntry& of = entry(i);
    return {static_cast<ChannelKind>(of.kind), of.bound, at, header().values, of.words, of.name};
  }
  /// Returns the place of the channel with this name; count() if there is none.
  std::size_t find(std::string_view name) const {
    std::size_t i = 0;
    while (i < count() && name != entry(i).name) ++i;
    return i;
  }
  std::uint64_t bytes() const {
    std::uint64_t all = is_empty() ? 0 : 8 + 16 * count();
    for (std::size_t i = 0; i < count(); ++i) all += entry(i).words;
    return 8 * all;
  }
};

/// Channels in memory. The view is valid while this object lives unchanged.
struct CellChannels {
  std::vector<std::uint64_t> words;

  ChannelsView view() const { return {words.empty() ? nullptr : words.data()}; }
};

/// Name, kind and bound of a channel.
struct ChannelSpec {
  std::string name;
  ChannelKind kind = ChannelKind::kF32;
  double bound = 0;

  friend bool operator==(const ChannelSpec&, const ChannelSpec&) = default;
};
inline ChannelSpec spec_of(const ChannelView& channel) {
  return {std::string(channel.name()), channel.kind, channel.bound};
}

/// Returns the name of a kind: "u8", "u16", "i16", "i32" or "f32".
constexpr const char* name_of(ChannelKind kind) {
  constexpr const char* kNames[] = {"u8", "u16", "i16", "i32", "f32"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// Returns whether channels may have this name: 1 to 63 letters, digits, '_', '-' and '.'.
inline bool is_channel_name(std::string_view name) {
  if (name.empty() || name.size() > 63) return false;
  for (const char c : name)
    if (!(c >= '0' && c <= '9') && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && c != '_' &&
        c != '-' && c != '.')
      return false;
  return true;
}

}  // namespace voxdag
