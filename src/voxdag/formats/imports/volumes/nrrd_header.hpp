#pragma once
/// Parses the text header of a NRRD file.
///
/// Format: "Definition of NRRD File Format" (teem.sourceforge.net/nrrd/format.html).
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/formats/imports/volumes/dense_source.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"

namespace voxdag {

struct NrrdHeader {
  DenseVolume volume;  ///< Without the threshold.
  VolumePlacement placement;
  std::map<Label, std::string> label_names;  ///< Of the segments of 3D Slicer.
  Encoding encoding = Encoding::kRaw;
  std::uint64_t line_skip = 0;
  std::int64_t byte_skip = 0;  ///< -1: raw data are at the end of their file.
  std::string data_file;       ///< Empty: the data follow the header.
  std::uint64_t end = 0;       ///< First byte after the header.
};

/// Parses the header at the start of a file. Throws Error with the line for a volume that is not of
/// three axes, or four with 3 or 4 channels of uint8 first, for encodings other than raw, gzip,
/// ascii and hex, and for data in several files.
NrrdHeader parse_nrrd_header(const std::filesystem::path& path, std::string_view text);

}  // namespace voxdag
