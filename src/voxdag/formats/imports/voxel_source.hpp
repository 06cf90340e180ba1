#pragma once
/// Files of voxels and of points, read as a stream.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "voxdag/builders/splats/splat.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/formats/imports/point_locator.hpp"
#include "voxdag/stored/attributes/channels.hpp"

namespace voxdag {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< Red, green and blue, sRGB encoded.

/// Returns a component of 0 to 1 in 8 bits. Clamps others; NaN becomes 0.
inline std::uint8_t color_byte(double component) {
  return static_cast<std::uint8_t>(component > 0 ? std::min(component, 1.0) * 255 + 0.5 : 0);
}

/// The number of what a place belongs to: a class, an object, an organ, a material. At most 2^53.
using Label = std::int64_t;

/// Some of the points or voxels of a source.
struct VoxelBatch {
  /// Points in world units, which may be NaN or infinite, or voxels as whole numbers.
  std::span<const Vec3d> places;
  std::span<const Rgb8> colors;  ///< One for each place; empty if the source has no colours.
  /// One for each place, its centre; empty if the source has no splats.
  std::span<const Splat> splats = {};
  /// One for each place; empty if the source has no labels.
  std::span<const Label> labels = {};
  /// For each place, a value of each of the source's channels; empty if it has none.
  std::span<const double> channels = {};
};
using VisitBatch = std::function<void(const VoxelBatch&)>;

/// A file that can be read several times. Errors name the file and the place.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;

  /// Returns whether the file has points in world units; otherwise it has voxels of a grid.
  virtual bool has_points() const = 0;
  virtual bool has_colors() const { return false; }
  /// Returns whether the points are Gaussian splats.
  virtual bool has_splats() const { return false; }
  /// Returns whether the places have labels: numbers of what they belong to. Only sources that were
  /// opened with VoxelSourceOptions::labels have them.
  virtual bool has_labels() const { return false; }
  /// Returns the names that the file or its format gives to labels, also to those without places.
  virtual std::map<Label, std::string> label_names() const { return {}; }
  /// Returns the channels of the places: those of VoxelSourceOptions::channels, in their order.
  virtual std::vector<ChannelSpec> channels() const { return {}; }
  /// Returns how exact the coordinates of points are.
  virtual CoordinateError coordinate_error() const { return {}; }
  /// Returns whether the colours come from an artist's palette. The import keeps these without
  /// loss by default, and gives a voxel the last of several colours.
  virtual bool has_palette() const { return false; }
  /// Returns the grid that the file names, if it names one. Points are then the centres of its
  /// voxels.
  virtual std::optional<Grid> grid() const { return std::nullopt; }
  /// Returns whether the file says where its voxels lie, or how large they are.
  virtual bool has_place() const { return false; }
  /// Returns the axis that points up if the file says it: 'y' or 'z'.
  virtual std::optional<char> up() const { return std::nullopt; }
  /// Returns the coordinates that the file gives voxel (0, 0, 0) of visit_all().
  virtual Vec3l first_voxel() const { return {}; }
  /// Returns warnings for the user, one line each, without the name of the file.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Calls visit() for all points or voxels, some at a time, in the order of the file. Throws
  /// Error, and what `visit` throws.
  virtual void visit_all(const VisitBatch& visit) const = 0;
};

/// Which labels to read: none, or for points those of the field with this name. An empty name
/// stands for the field that usually has them (label_value.hpp). Volumes have their values as
/// labels.
using LabelRequest = std::optional<std::string>;

/// A channel to read.
struct ChannelRequest {
  /// The field of points, the column of texts, the grid of .vdb files; for volumes of numbers
  /// "value".
  std::string field;
  std::string name;  ///< Of the channel. Empty: the field, with '_' for what names cannot have.
  double bound = 0;  ///< Above 0: the channel is f32 with this bound.
  std::optional<ChannelKind> kind = {};  ///< Default: that of the field's numbers.
};

struct VoxelSourceOptions {
  /// For volumes of numbers: values that are at least this set their voxel. Without it, all values
  /// other than 0 do.
  std::optional<double> threshold = {};
  bool use_placement = true;  ///< Reads the placement that voxdag export wrote beside the file.
  std::string format = {};    ///< The ending that tells the format, "xyz"; empty: that of the name.
  std::string grid = {};  ///< For .vdb files: the name of the grid to read; empty: see open_vdb().
  bool splats_are_points = false;  ///< Reads Gaussian splats as points: their centres.
  LabelRequest labels = {};
  std::vector<ChannelRequest> channels = {};
  Work work = {};  ///< Its budget counts what is unpacked.
};

/// Returns whether open_voxel_source() knows the end of the name. Files that end in .ply hold
/// points or a mesh.
bool is_voxel_source(const std::filesystem::path& name);

/// Returns whether the path is a folder that open_voxel_source() reads as one volume: of slices of
/// PNG or TIFF, or of images of DICOM.
bool is_slice_folder(const std::filesystem::path& path);

/// Opens a file by the end of its name, or a folder of slices. Files that gzip or Zstandard have
/// compressed and pipes are unpacked first (InputFile). Throws Error for formats that are
/// not known, for options that the format does not have, and for labels and channels that the file
/// does not have.
std::unique_ptr<VoxelSource> open_voxel_source(const std::filesystem::path& path,
                                               const VoxelSourceOptions& options = {});

}  // namespace voxdag
