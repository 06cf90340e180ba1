#include "voxdag/stored/attributes/encode_channels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/number_text.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/printable.hpp"

namespace voxdag {
namespace {

/// Returns whether |a - b| <= bound, exactly: the difference of two floats may need more than the
/// 53 bits of a double.
bool is_within(double a, double b, double bound) {
  if (a < b) std::swap(a, b);
  const double difference = a - b, part = difference - a;
  const double rest = (a - (difference - part)) - (b + part);  // Knuth's two-sum
  return difference < bound || (difference == bound && rest <= 0);
}

/// Sets `numbers` to the multiples of 2 bound that are nearest to the values of the codes. Returns
/// whether all of them are within the bound.
bool quantize(const ChannelView& channel, std::span<const std::int32_t> codes,
              std::span<std::int32_t> numbers) {
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const auto value = static_cast<double>(float_of_code(codes[i]));
    const double number = std::round(value / (2 * channel.bound));
    if (!(std::abs(number) <= std::numeric_limits<std::int32_t>::max())) return false;
    numbers[i] = static_cast<std::int32_t>(number);
    if (!is_within(channel.value_of({}, numbers[i]), value, channel.bound)) return false;
  }
  return true;
}

using BlockNumbers = std::array<std::int32_t, kChannelBlockValues>;

/// Sets the numbers that a block of these codes stores. Returns the block, without its begin.
template <class Code>
ChannelBlock describe(const ChannelView& channel, std::span<const Code> codes,
                      BlockNumbers& numbers) {
  ChannelBlock block;
  if constexpr (sizeof(Code) == 4)
    block.is_exact = channel.bound > 0 && !quantize(channel, codes, numbers);
  if (channel.bound == 0 || block.is_exact) std::copy(codes.begin(), codes.end(), numbers.begin());
  const auto [least, most] = std::minmax_element(
      numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(codes.size()));
  block.minimum = *least;
  block.width = static_cast<int>(
      std::bit_width(static_cast<std::uint32_t>(*most) - static_cast<std::uint32_t>(*least)));
  return block;
}

template <class Code>
EncodedChannel encode(const ChannelSpec& spec, std::span<const Code> codes, Work work) {
  check_channel(spec);
  EncodedChannel result{spec, {}};
  ChannelView channel{spec.kind, spec.bound, nullptr, codes.size(), 0, nullptr};
  const auto codes_of = [&](std::size_t i) {
    const std::size_t first = i * kChannelBlockValues;
    return codes.subspan(first, std::min<std::size_t>(kChannelBlockValues, codes.size() - first));
  };
  const std::size_t count = channel.block_count();
  const MemoryReservation block_bytes(work.memory, count * sizeof(ChannelBlock));
  std::vector<ChannelBlock> blocks(count);
  polled_for(count, 64, work, "channels", [&](std::size_t i) {
    BlockNumbers numbers;
    blocks[i] = describe(channel, codes_of(i), numbers);
  });
  std::uint64_t packed_words = 0;
  for (std::size_t i = 0; i < count; ++i) {
    blocks[i].begin = packed_words;
    packed_words += ChannelBlock::words_of(codes_of(i).size(), blocks[i].width);
  }
  const std::uint64_t words = ChannelBlock::kWords * count + packed_words;
  const MemoryReservation word_bytes(work.memory, 8 * words);
  result.words.resize(words);
  polled_for(count, 64, work, "channels", [&](std::size_t i) {
    BlockNumbers numbers;
    describe(channel, codes_of(i), numbers);
    const ChannelBlock& block = blocks[i];
    block.pack(result.words.data() + ChannelBlock::kWords * i);
    std::uint64_t* const packed = result.words.data() + ChannelBlock::kWords * count + block.begin;
    for (std::size_t k = 0; k < codes_of(i).size(); ++k)
      write_bits(
          packed, k * static_cast<std::uint64_t>(block.width), block.width,
          static_cast<std::uint32_t>(numbers[k]) - static_cast<std::uint32_t>(block.minimum));
  });
  return result;
}

}  // namespace

ChannelRange range_of(ChannelKind kind) {
  switch (kind) {
    case ChannelKind::kU8:
      return {0, 255};
    case ChannelKind::kU16:
      return {0, 65535};
    case ChannelKind::kI16:
      return {-32768, 32767};
    case ChannelKind::kI32:
      return {-2147483648.0, 2147483647.0};
    case ChannelKind::kF32:
      break;
  }
  constexpr double kMost = static_cast<double>(std::numeric_limits<float>::max());
  return {-kMost, kMost};
}

std::int32_t channel_code(ChannelKind kind, double value) {
  const ChannelRange range = range_of(kind);
  const double nearest = kind == ChannelKind::kF32 ? value : std::floor(value + 0.5);
  if (!(nearest >= range.least && nearest <= range.most))
    throw Error("", "",
                "has the value " + number_text(value) + ", and the kind " + name_of(kind) +
                    " has finite numbers from " + number_text(range.least) + " to " +
                    number_text(range.most));
  return kind == ChannelKind::kF32 ? code_of_float(static_cast<float>(value))
                                   : static_cast<std::int32_t>(nearest);
}

void check_channel(const ChannelSpec& spec) {
  if (!is_channel_name(spec.name))
    throw Error("", "",
                "a channel cannot have the name " + in_quotes(spec.name) +
                    ": names are 1 to 63 letters, digits, '_', '-' and '.'");
  // Threads whose subnormal numbers are 0 must store the same values.
  constexpr double kLeast = static_cast<double>(std::numeric_limits<float>::min());
  const bool is_zero = std::bit_cast<std::uint64_t>(spec.bound) == 0;
  if (!is_zero && !(spec.bound >= kLeast && spec.bound <= range_of(ChannelKind::kF32).most))
    throw Error("", "",
                "the channel " + in_quotes(spec.name) + " has the bound " +
                    number_text(spec.bound) + ", and bounds are 0, or finite and at least " +
                    number_text(kLeast));
  if (spec.bound > 0 && spec.kind != ChannelKind::kF32)
    throw Error("", "",
                "the channel " + in_quotes(spec.name) + " has whole numbers (" +
                    name_of(spec.kind) + "), which are kept without loss: bounds are for f32");
}

EncodedChannel encode_channel(const ChannelSpec& spec, std::span<const std::int32_t> codes,
                              Work work) {
  return encode(spec, codes, work);
}
EncodedChannel encode_channel(const ChannelSpec& spec, std::span<const std::uint8_t> codes,
                              Work work) {
  assert(spec.kind == ChannelKind::kU8);
  return encode(spec, codes, work);
}

EncodedChannel copy_channel(const ChannelView& channel) {
  return {spec_of(channel), {channel.words, channel.words + channel.word_count}};
}

std::uint64_t bytes_of(std::span<const EncodedChannel> channels) {
  std::uint64_t bytes = 0;
  for (const EncodedChannel& channel : channels) bytes += channel.words.size() * 8;
  return bytes;
}

CellChannels join_channels(std::uint64_t values, std::span<const EncodedChannel> channels) {
  if (channels.size() > kMaxChannels)
    throw Error("", "",
                "has " + std::to_string(channels.size()) + " channels, and at most " +
                    std::to_string(kMaxChannels) + " are stored");
  CellChannels result;
  if (channels.empty() || values == 0) return result;
  const ChannelsHeader header{static_cast<std::uint32_t>(channels.size()), 0, values, {}};
  result.words.resize((sizeof header + channels.size() * sizeof(ChannelEntry)) / 8);
  std::memcpy(result.words.data(), &header, sizeof header);
  std::size_t at = sizeof header / 8;
  for (const EncodedChannel& channel : channels) {
    for (const EncodedChannel* other = channels.data(); other != &channel; ++other)
      if (other->spec.name == channel.spec.name)
        throw Error("", "", "has two channels with the name " + in_quotes(channel.spec.name));
    ChannelEntry entry{};
    channel.spec.name.copy(entry.name, sizeof entry.name - 1);
    entry.kind = static_cast<std::uint32_t>(channel.spec.kind);
    entry.bound = channel.spec.bound;
    entry.words = channel.words.size();
    std::memcpy(result.words.data() + at, &entry, sizeof entry);
    at += sizeof entry / 8;
  }
  for (const EncodedChannel& channel : channels)
    result.words.insert(result.words.end(), channel.words.begin(), channel.words.end());
  return result;
}

ChannelRange range_of(const ChannelView& channel) {
  ChannelRange range{HUGE_VAL, -HUGE_VAL};
  for (std::uint64_t i = 0; i < channel.block_count(); ++i) {
    const ChannelBlock block = channel.block(i);
    const std::uint64_t count =
        std::min(kChannelBlockValues, channel.values - i * kChannelBlockValues);
    for (std::uint64_t k = 0; k < count; ++k) {
      const double value = channel.read(block, k);
      range = {std::min(range.least, value), std::max(range.most, value)};
    }
  }
  return range;
}

}  // namespace voxdag
