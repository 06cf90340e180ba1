#pragma once
/// Files of voxels and of points, read as a stream.
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< Red, green and blue, sRGB encoded.

/// Some of the points or voxels of a source.
struct VoxelBatch {
  std::span<const Vec3d> places;  ///< Points in world units, or voxels as whole numbers.
  std::span<const Rgb8> colors;   ///< One for each place; empty if the source has no colours.
};
using VisitBatch = std::function<void(const VoxelBatch&)>;

/// A file that can be read several times. Errors name the file and the place.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;

  /// Returns whether the file has points in world units; otherwise it has voxels of a grid.
  virtual bool has_points() const = 0;
  virtual bool has_colors() const { return false; }
  /// Returns the grid of the voxels, if the file has one.
  virtual std::optional<Grid> grid() const { return std::nullopt; }
  /// Returns warnings for the user, one line each.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Calls visit() for all points or voxels, some at a time, in the order of the file. Throws
  /// Error, and what `visit` throws.
  virtual void visit_all(const VisitBatch& visit) const = 0;
};

struct VoxelSourceOptions {
  /// For volumes of numbers: values that are at least this set their voxel. Without it, all values
  /// other than 0 do.
  std::optional<double> threshold;
};

/// Opens a file by the end of its name, or a folder of PNG files. Throws Error for formats that are
/// not known, and for options that the format does not have.
std::unique_ptr<VoxelSource> open_voxel_source(const std::filesystem::path& path,
                                               const VoxelSourceOptions& options = {});

}  // namespace voxdag
