#pragma once
/// Checks channels from an untrusted file.
#include <span>

#include "voxdag/stored/attributes/channels.hpp"

namespace voxdag {

/// Returns the channels of the chunk CHAN, for `cells` cells. Throws Error unless join_channels()
/// and encode_channel() make these words of some values, apart from the choice which blocks are
/// exact. Then ChannelView::read() is safe for every number, and its values are finite and of the
/// channel's kind. Linear time. The place of an error is "channel 2, block 17".
ChannelsView validate_channels(std::span<const std::uint64_t> words, std::uint64_t cells);

}  // namespace voxdag
