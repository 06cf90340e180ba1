#pragma once
/// Packs channels: the least bits of each block of 256 values.
#include <span>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/channels.hpp"

namespace voxdag {

/// The least and the greatest value of a kind.
struct ChannelRange {
  double least = 0, most = 0;
};
ChannelRange range_of(ChannelKind kind);

/// Returns the code of the value of this kind that is nearest to `value`; of two equally near whole
/// numbers the greater one. Throws Error, without a place, unless `value` is finite and not beyond
/// the range of the kind.
std::int32_t channel_code(ChannelKind kind, double value);
/// Returns the value of a code.
inline double value_of_code(ChannelKind kind, std::int32_t code) {
  return kind == ChannelKind::kF32 ? static_cast<double>(float_of_code(code)) : code;
}

/// Throws Error, without a place, unless a channel may be like this: see ChannelEntry.
void check_channel(const ChannelSpec& spec);

/// One channel, packed.
struct EncodedChannel {
  ChannelSpec spec;
  std::vector<std::uint64_t> words;  ///< ChannelView::words.
};

/// Returns the bytes of the packed values.
std::uint64_t bytes_of(std::span<const EncodedChannel> channels);

/// Packs the values whose codes are given, by number of cell. With a bound B, a value v is stored
/// as the float that is nearest to 2 B round(v / (2 B)), if all values of its block are then within
/// B; else the block is stored without loss. So no value differs by more than B. The result depends
/// on the arguments alone. Runs on the current TBB arena. Throws Error as check_channel(),
/// OverMemory and Cancelled.
EncodedChannel encode_channel(const ChannelSpec& spec, std::span<const std::int32_t> codes,
                              Work work = {});
/// Packs the values of a channel of the kind u8.
EncodedChannel encode_channel(const ChannelSpec& spec, std::span<const std::uint8_t> codes,
                              Work work = {});

/// Copies a channel as it is stored.
EncodedChannel copy_channel(const ChannelView& channel);

/// Joins channels of `values` values each. Without channels or values the result is empty. Throws
/// Error for more than kMaxChannels, and for two with one name.
CellChannels join_channels(std::uint64_t values, std::span<const EncodedChannel> channels);

/// The least and the greatest value that a channel has. `values` must not be 0.
ChannelRange range_of(const ChannelView& channel);

}  // namespace voxdag
