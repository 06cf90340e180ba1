#pragma once
/// The channels `metallic` and `roughness` of the kind u8, as kernels read them: 255 stands for 1.
/// Channels of other kinds with these names are other numbers.
#include "voxdag/core/metallic_roughness.hpp"
#include "voxdag/stored/attributes/channels.hpp"

namespace voxdag {

/// A view of a channel of the kind u8.
struct ByteChannelView {
  const std::uint64_t* words = nullptr;  ///< ChannelView::words; null: there is none.
  std::uint64_t blocks = 0, word_count = 0;

  VOXDAG_HD bool is_empty() const { return words == nullptr; }
  /// Returns the value of the cell with this number, 0 to 255.
  VOXDAG_HD std::uint32_t read(std::uint64_t number) const {
    const ChannelBlock block =
        ChannelBlock::unpack(words + ChannelBlock::kWords * (number / kChannelBlockValues));
    const std::uint64_t at = number % kChannelBlockValues * static_cast<std::uint64_t>(block.width);
    const std::uint64_t above =
        read_bits(words + ChannelBlock::kWords * blocks + block.begin, at, block.width);
    return static_cast<std::uint32_t>(block.minimum) + static_cast<std::uint32_t>(above);
  }
};

struct MetallicRoughnessView {
  ByteChannelView metallic, roughness;

  VOXDAG_HD bool is_empty() const { return metallic.is_empty() && roughness.is_empty(); }
  /// Returns the numbers of the cell with this number; the default of one without a channel.
  VOXDAG_HD MetallicRoughness read(std::uint64_t number) const {
    MetallicRoughness result;
    if (!metallic.is_empty())
      result.metallic = static_cast<float>(metallic.read(number)) * (1.0f / 255);
    if (!roughness.is_empty())
      result.roughness = static_cast<float>(roughness.read(number)) * (1.0f / 255);
    return result;
  }
};

inline MetallicRoughnessView metallic_roughness_of(const ChannelsView& channels) {
  const auto find = [&](std::string_view name) -> ByteChannelView {
    const std::size_t i = channels.find(name);
    if (i == channels.count() || channels[i].kind != ChannelKind::kU8) return {};
    return {channels[i].words, channels[i].block_count(), channels[i].word_count};
  };
  return {find("metallic"), find("roughness")};
}

}  // namespace voxdag
