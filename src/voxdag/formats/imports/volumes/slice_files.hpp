#pragma once
/// The files of a folder as slices of a volume, and the modules that decode slices. Programs load a
/// module when they open a file of its format.
#include <functional>
#include <string>
#include <vector>

#include "voxdag/formats/imports/volumes/dense_source.hpp"

namespace voxdag {

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
                       bool has_labels, const std::vector<ChannelRequest>& channels);
};

inline constexpr const char* kTiffModuleFile = "voxdag_tiff.so";
inline constexpr const char* kTiffModuleName = "voxdag_tiff_module";
inline constexpr const char* kDicomModuleFile = "voxdag_dicom.so";
inline constexpr const char* kDicomModuleName = "voxdag_dicom_module";

}  // namespace voxdag
