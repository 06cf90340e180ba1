#include "voxdag/stored/attributes/validate_channels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag {
namespace {

[[noreturn]] void fail_block(std::uint64_t block, const std::string& reason) {
  throw Error("", "block " + std::to_string(block), reason);
}

/// Throws Error unless the values for which the numbers `least` to `most` stand are finite and of
/// the channel's kind.
void check_numbers(const ChannelView& channel, std::uint64_t i, const ChannelBlock& block,
                   std::int32_t least, std::int32_t most) {
  const bool are_codes = channel.bound == 0 || block.is_exact;
  const ChannelRange range = range_of(channel.kind);
  const bool are_allowed = channel.kind == ChannelKind::kF32
                               ? are_codes ? least >= -kMaxFloatCode - 1 && most <= kMaxFloatCode
                                           : std::isfinite(channel.value_of(block, least)) &&
                                                 std::isfinite(channel.value_of(block, most))
                               : least >= range.least && most <= range.most;
  if (!are_allowed)
    fail_block(i,
               std::string("has values that are not those of the kind ") + name_of(channel.kind));
}

/// Checks the words of a channel, which are as many as its entry says.
void check_blocks(const ChannelView& channel) {
  const std::uint64_t blocks = channel.block_count();
  if (blocks > channel.word_count / ChannelBlock::kWords)
    fail_at("", "has " + std::to_string(channel.word_count) + " words, too few for its " +
                    std::to_string(blocks) + " blocks");
  const std::uint64_t packed_words = channel.word_count - ChannelBlock::kWords * blocks;
  const std::uint64_t* const packed = channel.words + ChannelBlock::kWords * blocks;
  std::uint64_t begin = 0;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const ChannelBlock block = channel.block(i);
    std::uint64_t again[ChannelBlock::kWords];
    block.pack(again);
    if (block.width > ChannelBlock::kMaxWidth || again[1] != channel.words[2 * i + 1] ||
        (block.is_exact && channel.bound == 0))
      fail_block(i, "has unknown bits");
    if (block.begin != begin) fail_block(i, "does not begin where the block before it ends");
    const std::uint64_t values =
        std::min(kChannelBlockValues, channel.values - i * kChannelBlockValues);
    const std::uint64_t words = ChannelBlock::words_of(values, block.width);
    if (words > packed_words - begin) fail_block(i, "ends after the last word");
    std::uint64_t least = UINT64_MAX, most = 0;
    const auto width = static_cast<std::uint64_t>(block.width);
    for (std::uint64_t k = 0; k < values; ++k) {
      const std::uint64_t above = read_bits(packed + begin, k * width, block.width);
      least = std::min(least, above);
      most = std::max(most, above);
    }
    if (least != 0 || static_cast<int>(std::bit_width(most)) != block.width)
      fail_block(i, "is not packed in the fewest bits");
    if (most > static_cast<std::uint64_t>(std::int64_t{INT32_MAX} - block.minimum))
      fail_block(i, "has numbers beyond 32 bits");
    check_numbers(channel, i, block, block.minimum,
                  static_cast<std::int32_t>(block.minimum + static_cast<std::int64_t>(most)));
    const std::uint64_t last_bits = values * width % 64;
    if (last_bits != 0 && packed[begin + words - 1] >> last_bits != 0)
      fail_block(i, "padding is not zero");
    begin += words;
  }
  if (begin != packed_words) fail_at("", "has words after the last block");
}

void check_entry(const ChannelsView& channels, std::size_t i) {
  const ChannelEntry& entry = channels.entry(i);
  const char *const begin = std::begin(entry.name), *const end = std::end(entry.name);
  const char* const name_end = std::find(begin, end, '\0');
  if (std::any_of(name_end, end, [](char c) { return c != '\0'; }))
    fail_at("", "has bytes after its name");
  if (entry.kind >= kChannelKinds)
    fail_at("", "has the unknown kind " + std::to_string(entry.kind) + ": 0 to 4 are allowed");
  check_channel({{begin, name_end}, static_cast<ChannelKind>(entry.kind), entry.bound});
  if (channels.find(entry.name) != i) fail_at("", "has the name of another channel");
  if (entry.reserved != 0 || std::any_of(std::begin(entry.padding), std::end(entry.padding),
                                         [](std::uint64_t word) { return word != 0; }))
    fail_at("", "reserved bytes are not zero");
}

}  // namespace

ChannelsView validate_channels(std::span<const std::uint64_t> words, std::uint64_t cells) {
  constexpr std::uint64_t kHeaderWords = sizeof(ChannelsHeader) / 8,
                          kEntryWords = sizeof(ChannelEntry) / 8;
  if (words.size() < kHeaderWords)
    fail_at("", "has " + std::to_string(8 * words.size()) + " bytes, but its header needs " +
                    std::to_string(sizeof(ChannelsHeader)));
  const ChannelsView channels{words.data()};
  const ChannelsHeader& header = channels.header();
  if (header.channels < 1 || header.channels > kMaxChannels)
    fail_at("", "has " + std::to_string(header.channels) + " channels: 1 to " +
                    std::to_string(kMaxChannels) + " are allowed");
  if (header.reserved != 0 || std::any_of(std::begin(header.padding), std::end(header.padding),
                                          [](std::uint64_t word) { return word != 0; }))
    fail_at("", "reserved bytes of the header are not zero");
  if (header.values != cells || cells == 0)
    fail_at("", "has " + std::to_string(header.values) + " values, but the DAG has " +
                    std::to_string(cells) + " numbered cells");
  if (kEntryWords * header.channels > words.size() - kHeaderWords)
    fail_at("", "ends inside the table of its channels");
  std::uint64_t left = words.size() - kHeaderWords - kEntryWords * header.channels;
  for (std::size_t i = 0; i < header.channels; ++i) {
    try {
      check_entry(channels, i);
      if (channels.entry(i).words > left) fail_at("", "ends after the last word");
      left -= channels.entry(i).words;
      check_blocks(channels[i]);
    } catch (const Error& error) {
      throw error.within("channel " + std::to_string(i));
    }
  }
  if (left != 0) fail_at("", "has words after the last channel");
  return channels;
}

}  // namespace voxdag
