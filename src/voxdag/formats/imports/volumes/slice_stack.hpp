#pragma once
/// Volumes whose slices are decoded one at a time, and the modules that read such files. Programs
/// load a module when they open a file of its format.
#include <functional>
#include <string>
#include <vector>

#include "voxdag/formats/imports/volumes/volume_grid.hpp"

namespace voxdag {

/// A volume in slices along z.
struct SliceStack {
  DenseVolume volume = {};
  VolumeMap map = VolumeMap{};
  bool has_place = false;  ///< The file says where the volume lies, or how large its voxels are.
  std::vector<std::string> warnings = {};
  /// Fills the span with the values of slice z, in the order of the volume. Slices are asked for in
  /// order. Throws Error.
  std::function<void(std::uint64_t z, std::span<std::byte> bytes)> read;
};

/// A slice has less bytes than this.
inline constexpr std::uint64_t kMaxSliceBytes = std::uint64_t{1} << 30;

/// Returns the source of the volume. Throws Error with this path if its slices are too large, or if
/// labels are wanted of colours or of real numbers.
std::unique_ptr<VoxelSource> make_slice_source(const std::filesystem::path& path, SliceStack stack);

/// Returns the names of the files in a folder for which is_slice(name) holds and which do not begin
/// with a dot, sorted by name, numbers by their value. Throws Error if the folder cannot be read.
std::vector<std::string> names_of_slices(const std::filesystem::path& folder,
                                         const std::function<bool(const std::string&)>& is_slice);

/// Returns the last number in a name; nothing if it has none of at most 18 digits.
std::optional<std::int64_t> last_number(std::string_view name);

/// Returns a warning if numbers are missing between those of the names; empty if none are.
std::string missing_slices(const std::vector<std::string>& names);

/// Returns whether the file begins as files of DICOM do.
bool is_dicom(const std::filesystem::path& path);
/// Returns whether a folder has a file of DICOM.
bool has_dicom(const std::filesystem::path& folder);

/// The interface of voxdag_tiff.so and voxdag_dicom.so.
struct SliceModule {
  VoxelSource* (*open)(const std::filesystem::path& path, std::optional<double> threshold,
                       bool has_labels);
};

inline constexpr const char* kTiffModuleFile = "voxdag_tiff.so";
inline constexpr const char* kTiffModuleName = "voxdag_tiff_module";
inline constexpr const char* kDicomModuleFile = "voxdag_dicom.so";
inline constexpr const char* kDicomModuleName = "voxdag_dicom_module";

}  // namespace voxdag
