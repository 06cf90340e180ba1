#pragma once
/// Channels as fields of the rows of exported files.
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {

/// The channels of a look, in the types of exported files: a number of the channel's kind each.
class ChannelFields {
 public:
  /// Refers to `look`.
  explicit ChannelFields(const LookReader& look) : look_(look) {
    for (const ChannelView& channel : look.channels()) bytes_ += size_of(channel.kind);
  }

  bool is_empty() const { return look_.channels().empty(); }
  std::size_t count() const { return look_.channels().size(); }
  /// Returns the bytes of all fields of a row.
  std::size_t bytes() const { return bytes_; }
  ChannelKind kind(std::size_t i) const { return look_.channels()[i].kind; }
  static std::size_t size_of(ChannelKind kind) {
    return with_kind(kind, [](auto zero) { return sizeof zero; });
  }
  std::string name(std::size_t i, std::span<const char* const> taken) const {
    return field_name(look_.channels(), i, taken);
  }
  /// Returns the name of a field: that of channel `i`, after "channel_" if it is one of `taken`;
  /// after more of these if another channel has that name.
  static std::string field_name(std::span<const ChannelView> channels, std::size_t i,
                                std::span<const char* const> taken) {
    std::string name(channels[i].name());
    const auto is_taken = [&] {
      if (std::find(taken.begin(), taken.end(), name) != taken.end()) return true;
      for (std::size_t k = 0; k < channels.size(); ++k)
        if (k != i && channels[k].name() == name) return true;
      return false;
    };
    while (is_taken()) name.insert(0, "channel_");
    return name;
  }
  /// Returns the field of a structured type of NumPy: ", ('heat', '<f4')".
  static std::string npy_field(std::span<const ChannelView> channels, std::size_t i,
                               std::span<const char* const> taken) {
    constexpr const char* kTypes[] = {"|u1", "<u2", "<i2", "<i4", "<f4"};
    return ", ('" + field_name(channels, i, taken) + "', '" +
           kTypes[static_cast<std::size_t>(channels[i].kind)] + "')";
  }
  /// Returns the bytes of the fields of a voxel, valid until the next call.
  std::span<const std::byte> row(Vec3i voxel, int level) {
    std::array<double, kMaxChannels> values;
    look_.read_channels(voxel, level, values);
    row_.clear();
    for (std::size_t i = 0; i < count(); ++i) {
      with_kind(kind(i), [&]<class T>(T) {
        const T value = static_cast<T>(values[i]);
        const auto bytes = std::as_bytes(std::span(&value, 1));
        row_.insert(row_.end(), bytes.begin(), bytes.end());
      });
    }
    return row_;
  }

 private:
  const LookReader& look_;
  std::size_t bytes_ = 0;
  std::vector<std::byte> row_;
};

}  // namespace voxdag
