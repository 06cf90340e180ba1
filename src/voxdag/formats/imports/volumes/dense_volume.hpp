#pragma once
/// Dense volumes: a value, or a colour, for each voxel of a box.
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "voxdag/formats/imports/value_type.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

using VolumeSize = std::array<std::uint64_t, 3>;  ///< Voxels along x, y and z.

/// How a volume's values lie in a stream of bytes, and which of them set their voxel.
struct DenseVolume {
  VolumeSize size{};  ///< As check_volume_size() allows.
  ValueType type = ValueType::kUint8;
  bool is_big_endian = false;
  bool is_z_fastest = false;  ///< The order is z, y, x; otherwise x, y, z.
  /// Numbers of a voxel, next to each other. 1: a value. 3 or 4: red, green, blue and alpha of type
  /// kUint8. Any number if is_list: a value in each layer.
  int channels = 1;
  bool is_list = false;  ///< The volume has layers. A voxel is set if any layer sets it.
  int repeats = 1;       ///< Layers of a list that follow each other as whole volumes.
  static constexpr std::uint64_t kMaxLayers = 4096;
  double slope = 1, intercept = 0;  ///< A value is slope * number + intercept.
  /// Values that are at least this set their voxel; without it, all values but 0. NaN sets none.
  /// The threshold is compared with the alpha of a colour, or with the greatest channel if the
  /// colour has no alpha.
  std::optional<double> threshold;
  bool has_labels = false;        ///< Values of one channel are labels, too.
  bool has_values = false;        ///< Values are passed on, as VoxelBatch::channels.
  bool has_opaque_alpha = false;  ///< Alpha is 255 everywhere: the greatest channel counts.

  bool has_colors() const { return channels > 1 && !is_list; }
  std::uint64_t voxel_bytes() const {
    return bytes_of(type) * static_cast<std::uint64_t>(channels);
  }
  std::uint64_t voxels() const { return size[0] * size[1] * size[2]; }
  /// Returns the length of the stream. Throws Error if it is not less than 2^63.
  std::uint64_t bytes() const;
};

/// Throws Error unless every side has 1 to 1,048,576 voxels.
void check_volume_size(const std::filesystem::path& path, const VolumeSize& size);

/// Returns the least number of levels that hold the volume.
int levels_of(const VolumeSize& size);

/// Fills the span with the next bytes of a stream, or throws Error.
using FillBytes = std::function<void(std::span<std::byte>)>;

/// Returns whether the alpha of a volume of RGBA is 255 everywhere. Stops reading at one that is
/// not.
bool has_opaque_alpha(const DenseVolume& volume, const FillBytes& fill);

/// Calls visit() for the voxels that are set, in the order of the stream, with their colours if the
/// volume has channels. Reads exactly volume.bytes(), 64 KiB at a time.
void visit_volume(const DenseVolume& volume, const FillBytes& fill, const VisitBatch& visit);

}  // namespace voxdag
