#pragma once
/// Dense volumes: a value, or a colour, for each voxel of a box.
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "voxdag/formats/imports/volumes/value_type.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

using VolumeSize = std::array<std::uint64_t, 3>;  ///< Voxels along x, y and z.

/// How a volume's values lie in a stream of bytes, and which of them set their voxel.
struct DenseVolume {
  VolumeSize size{};  ///< As check_volume_size() allows.
  ValueType type = ValueType::kUint8;
  bool is_big_endian = false;
  bool is_z_fastest = false;  ///< The order is z, y, x; otherwise x, y, z.
  /// 1: values. 3 or 4: red, green, blue and alpha of type kUint8, next to each other.
  int channels = 1;
  double slope = 1, intercept = 0;  ///< A value is slope * number + intercept.
  /// Values that are at least this set their voxel; without it, all values but 0. NaN sets none.
  /// With 4 channels the value is alpha; with 3 channels it is the greatest of them.
  std::optional<double> threshold;

  std::uint64_t voxel_bytes() const {
    return bytes_of(type) * static_cast<std::uint64_t>(channels);
  }
  /// Returns the length of the stream: less than 2^64, because a side has at most 2^20 voxels.
  std::uint64_t bytes() const { return size[0] * size[1] * size[2] * voxel_bytes(); }
};

/// Throws Error unless every side has 1 to 1,048,576 voxels.
void check_volume_size(const std::filesystem::path& path, const VolumeSize& size);

/// Returns the least number of levels that hold the volume.
int levels_of(const VolumeSize& size);

/// Fills the span with the next bytes of a stream, or throws Error.
using FillBytes = std::function<void(std::span<std::byte>)>;

/// Calls visit() for the voxels that are set, in the order of the stream, with their colours if the
/// volume has channels. Reads exactly volume.bytes(), 64 KiB at a time.
void visit_volume(const DenseVolume& volume, const FillBytes& fill, const VisitBatch& visit);

}  // namespace voxdag
