#include "cli/channel_columns.hpp"

#include <cstring>
#include <limits>

#include "voxdag/formats/exports/channel_fields.hpp"

namespace voxdag::cli {

ChannelColumns::ChannelColumns(const ColoredDagView& dag, std::span<const char* const> taken)
    : dag_(dag) {
  for (std::size_t i = 0; i < dag.attributes.channels.count(); ++i)
    channels_.push_back(dag.attributes.channels[i]);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    dtype_ += ChannelFields::npy_field(channels_, i, taken);
    bytes_ += ChannelFields::size_of(channels_[i].kind);
  }
}

std::byte* ChannelColumns::store(std::byte* row, bool exists, Vec3i cell, int level) const {
  std::uint64_t number = 0;
  exists = exists && !channels_.empty() && find_number(dag_, cell, level, number);
  for (const ChannelView& channel : channels_)
    with_kind(channel.kind, [&]<class T>(T) {
      const T none = std::numeric_limits<T>::quiet_NaN();  // 0 for whole numbers
      const T value = exists ? static_cast<T>(channel.read(number)) : none;
      std::memcpy(row, &value, sizeof value);
      row += sizeof value;
    });
  return row;
}

}  // namespace voxdag::cli
