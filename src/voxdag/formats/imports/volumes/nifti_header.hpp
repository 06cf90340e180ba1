#pragma once
/// Parses the binary header of a NIfTI file.
///
/// Format: nifti1.h and nifti2.h of the NIfTI Data Format Working Group (nifti.nimh.nih.gov).
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "voxdag/formats/imports/volumes/volume_grid.hpp"

namespace voxdag {

/// Bytes of the longest header.
inline constexpr std::size_t kNiftiHeaderBytes = 540;

struct NiftiHeader {
  DenseVolume volume;  ///< Without the threshold.
  VolumePlacement placement;
  bool has_more_volumes = false;  ///< Along the axes after z.
  std::uint64_t data = 0;         ///< First byte of the data.
};

/// Parses the header at the start of `bytes`, which are those of the uncompressed file. Throws
/// Error with the byte.
NiftiHeader parse_nifti_header(const std::filesystem::path& path, std::string_view bytes);

}  // namespace voxdag
