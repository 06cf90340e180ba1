#include "voxdag/formats/imports/volumes/dense_volume.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/volumes/value_test.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;

/// Passes each voxel's place and bytes to `use`.
template <class Use>
void for_each_item(const DenseVolume& volume, const FillBytes& fill, const Use& use) {
  const std::size_t item = volume.voxel_bytes(), number = bytes_of(volume.type);
  const bool is_swapped = volume.is_big_endian != (std::endian::native == std::endian::big);
  const std::size_t fast = volume.is_z_fastest ? 2 : 0, slow = 2 - fast;
  std::vector<std::byte> buffer(kBufferBytes / item * item);
  std::uint64_t left = volume.size[0] * volume.size[1] * volume.size[2];
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

Vec3d place_of(const std::array<std::uint64_t, 3>& at) {
  return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

template <class T, class Test>
void visit_values(const DenseVolume& volume, const FillBytes& fill, BatchedVoxels& voxels,
                  const Test& is_set) {
  for_each_item(volume, fill, [&](const auto& at, const std::byte* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    if (is_set(value)) voxels.add(place_of(at));
  });
}

template <class T>
void visit_type(const DenseVolume& volume, const FillBytes& fill, BatchedVoxels& voxels) {
  const bool is_scaled = volume.slope != 1 || volume.intercept != 0;
  const auto scaled = [&](auto test) {
    return ScaledTest<T, decltype(test)>{test, volume.slope, volume.intercept};
  };
  if (is_scaled && volume.threshold)
    visit_values<T>(volume, fill, voxels, scaled(IsAtLeast<double>(*volume.threshold)));
  else if (is_scaled)
    visit_values<T>(volume, fill, voxels, scaled(IsNotZero<double>()));
  else if (volume.threshold)
    visit_values<T>(volume, fill, voxels, IsAtLeast<T>(*volume.threshold));
  else
    visit_values<T>(volume, fill, voxels, IsNotZero<T>());
}

template <class Test>
void visit_colors(const DenseVolume& volume, const FillBytes& fill, BatchedVoxels& voxels,
                  const Test& is_set) {
  for_each_item(volume, fill, [&](const auto& at, const std::byte* bytes) {
    const auto channel = [&](int i) { return std::to_integer<std::uint8_t>(bytes[i]); };
    const Rgb8 color{channel(0), channel(1), channel(2)};
    if (is_set(volume.channels == 4 ? channel(3) : std::max({color[0], color[1], color[2]})))
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

void visit_volume(const DenseVolume& volume, const FillBytes& fill, const VisitBatch& visit) {
  BatchedVoxels voxels(visit);
  if (volume.channels == 1)
    with_type(volume.type, [&](auto zero) { visit_type<decltype(zero)>(volume, fill, voxels); });
  else if (volume.threshold)
    visit_colors(volume, fill, voxels, IsAtLeast<std::uint8_t>(*volume.threshold));
  else
    visit_colors(volume, fill, voxels, IsNotZero<std::uint8_t>());
  voxels.finish();
}

}  // namespace voxdag
