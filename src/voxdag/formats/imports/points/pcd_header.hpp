#pragma once
/// The header of a PCD file (Point Cloud Library, The PCD file format).
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace voxdag {

/// A field of a point, with one or more values. Names are views into the file.
struct PcdField {
  std::string_view name;
  char type = 'F';            ///< F: float, I: signed, U: unsigned.
  std::uint64_t size = 4;     ///< Bytes of a value.
  std::uint64_t count = 1;    ///< Values.
  std::uint64_t offset = 0;   ///< Bytes before the field in a point.
  std::uint64_t ordinal = 0;  ///< Values before the field in a point.
};

enum class PcdData : std::uint8_t { kAscii, kBinary, kCompressed };

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t points = 0;
  std::uint64_t point_bytes = 0;   ///< Bytes of all fields.
  std::uint64_t point_values = 0;  ///< Values of all fields.
  PcdData data = PcdData::kAscii;
  std::size_t body = 0;  ///< Offset of the first byte after the header.

  /// Returns the index of the first field of a name, or -1.
  int find(std::string_view name) const;
};

/// Parses the header and checks it: every line is known, fields have one type each, POINTS is WIDTH
/// × HEIGHT, and a body that is not compressed has room for all points. Throws Error with the line.
PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name);

}  // namespace voxdag
