#pragma once
/// The public header block of a LAS file (ASPRS, LAS Specification 1.0 to 1.4).
#include <cstdint>
#include <string>
#include <string_view>

#include "voxdag/core/vec.hpp"

namespace voxdag {

inline constexpr const char* kCompressedLas =
    "is a compressed LAS file (LAZ), which is not read: decompress it with laszip or PDAL";

struct LasHeader {
  int minor_version = 0;  ///< 0 to 4.
  int format = 0;         ///< Of the point records, 0 to 10.
  std::uint64_t points = 0;
  std::uint64_t data = 0;          ///< Offset of the first record.
  std::uint64_t record_bytes = 0;  ///< Of one record, with its extra bytes.
  Vec3d scale, offset;             ///< World coordinate = integer × scale + offset.
  /// Version 1.4 has two counts, which disagree.
  bool has_two_counts = false;
};

/// Parses the header and checks it: the file has all its records, and all coordinates are finite.
/// If the two counts of version 1.4 differ, a legacy count other than 0 wins, as the specification
/// says.
/// Throws Error(name, byte, reason).
LasHeader parse_las_header(std::string_view bytes, const std::string& name);

/// Returns the offset in a record of red, green and blue, 16 bits each; 0 if the format has none.
int las_color_offset(int format);

}  // namespace voxdag
