#include "voxdag/formats/imports/volumes/dense_volume.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/value_test.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;

/// Passes each voxel's place and bytes to `use`.
template <class Use>
void for_each_item_once(const DenseVolume& volume, const FillBytes& fill, const Use& use) {
  const std::size_t item = volume.voxel_bytes(), number = bytes_of(volume.type);
  const bool is_swapped = volume.is_big_endian != (std::endian::native == std::endian::big);
  const std::size_t fast = volume.is_z_fastest ? 2 : 0, slow = 2 - fast;
  std::vector<std::byte> buffer(kBufferBytes / item * item);
  std::uint64_t left = volume.voxels();
  std::array<std::uint64_t, 3> at{};
  while (left > 0) {
    const std::uint64_t count = std::min<std::uint64_t>(left, buffer.size() / item);
    left -= count;
    const std::span<std::byte> bytes(buffer.data(), count * item);
    fill(bytes);
    if (is_swapped && number > 1)
      for (std::size_t i = 0; i < bytes.size(); i += number)
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                     bytes.begin() + static_cast<std::ptrdiff_t>(i + number));
    for (std::uint64_t i = 0; i < count;) {
      const std::uint64_t run = std::min(count - i, volume.size[fast] - at[fast]);
      for (const std::uint64_t end = i + run; i < end; ++i, ++at[fast])
        use(at, bytes.data() + i * item);
      if (at[fast] < volume.size[fast]) continue;
      at[fast] = 0;
      if (++at[1] < volume.size[1]) continue;
      at[1] = 0;
      ++at[slow];
    }
  }
}

/// The same, for all volumes behind each other.
template <class Use>
void for_each_item(const DenseVolume& volume, const FillBytes& fill, const Use& use) {
  for (int i = 0; i < volume.repeats; ++i) for_each_item_once(volume, fill, use);
}

Vec3d place_of(const std::array<std::uint64_t, 3>& at) {
  return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

/// The type in which a number is compared.
template <class T>
using Compared = std::conditional_t<std::is_same_v<T, Half>, float, T>;

template <class T>
Label label_in(const DenseVolume& volume, T value) {
  if (volume.slope == 1 && volume.intercept == 0) return label_of(value);
  return label_of(static_cast<double>(value) * volume.slope + volume.intercept);
}

template <class T, class Test>
void visit_values(const DenseVolume& volume, const FillBytes& fill, BatchedVoxels& voxels,
                  const Test& is_set) {
  for_each_item(volume, fill, [&](const auto& at, const std::byte* bytes) {
    for (int layer = 0; layer < volume.channels; ++layer) {
      T value;
      std::memcpy(&value, bytes + sizeof value * static_cast<std::size_t>(layer), sizeof value);
      if (!is_set(static_cast<Compared<T>>(value))) continue;
      if (volume.has_labels) voxels.add_label(label_in(volume, static_cast<Compared<T>>(value)));
      if (volume.has_values)
        voxels.add_channel(static_cast<double>(static_cast<Compared<T>>(value)) * volume.slope +
                           volume.intercept);
      voxels.add(place_of(at));
      return;
    }
  });
}

template <class T>
void visit_type(const DenseVolume& volume, const FillBytes& fill, BatchedVoxels& voxels) {
  const bool is_scaled = volume.slope != 1 || volume.intercept != 0;
  const auto scaled = [&](auto test) {
    return ScaledTest<Compared<T>, decltype(test)>{test, volume.slope, volume.intercept};
  };
  if (is_scaled && volume.threshold)
    visit_values<T>(volume, fill, voxels, scaled(IsAtLeast<double>(*volume.threshold)));
  else if (is_scaled)
    visit_values<T>(volume, fill, voxels, scaled(IsNotZero<double>()));
  else if (volume.threshold)
    visit_values<T>(volume, fill, voxels, IsAtLeast<Compared<T>>(*volume.threshold));
  else
    visit_values<T>(volume, fill, voxels, IsNotZero<Compared<T>>());
}

template <class Test>
void visit_colors(const DenseVolume& volume, const FillBytes& fill, BatchedVoxels& voxels,
                  const Test& is_set) {
  for_each_item(volume, fill, [&](const auto& at, const std::byte* bytes) {
    const auto channel = [&](int i) { return std::to_integer<std::uint8_t>(bytes[i]); };
    const Rgb8 color{channel(0), channel(1), channel(2)};
    const bool uses_alpha = volume.channels == 4 && !volume.has_opaque_alpha;
    if (is_set(uses_alpha ? channel(3) : std::max({color[0], color[1], color[2]})))
      voxels.add(place_of(at), color);
  });
}

}  // namespace

void check_volume_size(const std::filesystem::path& path, const VolumeSize& size) {
  constexpr std::uint64_t kMaxSide = std::uint64_t{1} << kMaxLevels;
  for (const std::uint64_t side : size)
    if (side < 1 || side > kMaxSide)
      throw Error(
          path.string(), "header",
          "a side of the volume has " + std::to_string(side) + " voxels; 1 to 1048576 are allowed");
}

int levels_of(const VolumeSize& size) {
  const std::uint64_t side = std::max({size[0], size[1], size[2]});
  return std::max(kMinLevels, static_cast<int>(std::bit_width(side - 1)));
}

std::uint64_t DenseVolume::bytes() const {
  // At most 2^60 voxels of at most 8 * 4096 bytes.
  std::uint64_t bytes = 0;
  const auto per_voxel = voxel_bytes() * static_cast<std::uint64_t>(repeats);
  if (__builtin_mul_overflow(voxels(), per_voxel, &bytes) || bytes > INT64_MAX)
    throw Error("", "header", "the volume has more than 2^63 bytes");
  return bytes;
}

bool has_opaque_alpha(const DenseVolume& volume, const FillBytes& fill) {
  std::vector<std::byte> buffer(kBufferBytes);
  for (std::uint64_t left = volume.bytes(); left > 0;) {
    const std::span<std::byte> bytes(buffer.data(), std::min<std::uint64_t>(left, buffer.size()));
    fill(bytes);
    left -= bytes.size();
    for (std::size_t i = 3; i < bytes.size(); i += 4)
      if (bytes[i] != std::byte{255}) return false;
  }
  return true;
}

void visit_volume(const DenseVolume& volume, const FillBytes& fill, const VisitBatch& visit) {
  BatchedVoxels voxels(visit);
  if (!volume.has_colors())
    with_type(volume.type, [&](auto zero) { visit_type<decltype(zero)>(volume, fill, voxels); });
  else if (volume.threshold)
    visit_colors(volume, fill, voxels, IsAtLeast<std::uint8_t>(*volume.threshold));
  else
    visit_colors(volume, fill, voxels, IsNotZero<std::uint8_t>());
  voxels.finish();
}

}  // namespace voxdag
