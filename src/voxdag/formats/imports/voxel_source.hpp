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
#include "voxdag/formats/imports/point_locator.hpp"

namespace voxdag {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< Red, green and blue, sRGB encoded.

/// Some of the points or voxels of a source.
struct VoxelBatch {
  /// Points in world units, perhaps some that are not finite, or voxels as whole numbers.
  std::span<const Vec3d> places;
  std::span<const Rgb8> colors;  ///< One for each place; empty if the source has no colours.
};
using VisitBatch = std::function<void(const VoxelBatch&)>;

/// A file that can be read several times. Errors name the file and the place.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;

  /// Returns whether the file has points in world units; otherwise it has voxels of a grid.
  virtual bool has_points() const = 0;
  virtual bool has_colors() const { return false; }
  /// Returns how exact the coordinates of points are.
  virtual CoordinateError coordinate_error() const { return {}; }
  /// Returns whether the colours are those of a palette, as artists choose it: they are kept
  /// without loss by default, and of several colours of a voxel the last one counts.
  virtual bool has_palette() const { return false; }
  /// Returns the grid of the voxels, if the file has one; of points, the one whose voxels they are
  /// the centres of.
  virtual std::optional<Grid> grid() const { return std::nullopt; }
  /// Returns whether the file says where its voxels lie, or how large they are.
  virtual bool has_place() const { return false; }
  /// Returns what the file calls voxel (0, 0, 0) of visit_all().
  virtual Vec3l first_voxel() const { return {}; }
  /// Returns warnings for the user, one line each, without the name of the file.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Calls visit() for all points or voxels, some at a time, in the order of the file. Throws
  /// Error, and what `visit` throws.
  virtual void visit_all(const VisitBatch& visit) const = 0;
};

struct VoxelSourceOptions {
  /// For volumes of numbers: values that are at least this set their voxel. Without it, all values
  /// other than 0 do.
  std::optional<double> threshold;
  bool use_placement = true;  ///< Reads the placement that voxdag export wrote beside the file.
};

/// Opens a file by the end of its name, or a folder of PNG files. Throws Error for formats that are
/// not known, and for options that the format does not have.
std::unique_ptr<VoxelSource> open_voxel_source(const std::filesystem::path& path,
                                               const VoxelSourceOptions& options = {});

}  // namespace voxdag
