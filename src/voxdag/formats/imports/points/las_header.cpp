#include "voxdag/formats/imports/points/las_header.hpp"

#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/points/load_value.hpp"

namespace voxdag {
namespace {

/// Bytes of a record, per format.
constexpr std::uint64_t kRecordBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// Offsets of fields, in bytes.
constexpr std::size_t kMajorVersion = 24, kMinorVersion = 25, kHeaderBytes = 94, kDataOffset = 96,
                      kFormat = 104, kRecordLength = 105, kLegacyPoints = 107, kScale = 131,
                      kOffset = 155, kPoints = 247;

/// The fields up to the bounds; what versions 1.3 to 1.5 add behind them is needed for the count of
/// 64 bits only. Some writers of 1.3 leave their addition out.
constexpr std::uint64_t kMinHeaderBytes = 227, kLongHeaderBytes = 375;

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  LasHeader parse() {
    if (!bytes_.starts_with("LASF")) fail(0, "is not a LAS file: it does not start with 'LASF'");
    check_versions();
    const auto format = load<std::uint8_t>(kFormat);
    if ((format & 0xC0) != 0) fail(kFormat, kCompressedLas);
    if (format > 10) fail(kFormat, "point format " + std::to_string(format) + " is not 0 to 10");
    header_.format = format;
    header_.record_bytes = load<std::uint16_t>(kRecordLength);
    if (header_.record_bytes < kRecordBytes[format])
      fail(kRecordLength, "point records of " + std::to_string(header_.record_bytes) +
                              " bytes are too short for format " + std::to_string(format) + ": " +
                              std::to_string(kRecordBytes[format]) + " bytes");
    read_count();
    read_scales();
    return header_;
  }

 private:
  [[noreturn]] void fail(std::size_t byte, const std::string& reason) const {
    throw Error(name_, ErrorPlace::byte(byte), reason);
  }
  template <class T>
  T load(std::size_t byte) const {
    if (bytes_.size() < byte + sizeof(T)) fail(bytes_.size(), "the file ends inside its header");
    return load_value<T>(bytes_.data() + byte);
  }

  void check_versions() {
    const int major = load<std::uint8_t>(kMajorVersion), minor = load<std::uint8_t>(kMinorVersion);
    if (major != 1 || minor > 5)
      fail(kMajorVersion, "LAS version " + std::to_string(major) + "." + std::to_string(minor) +
                              " is not 1.0 to 1.5");
    header_.minor_version = minor;
    const std::uint64_t least = minor >= 4 ? kLongHeaderBytes : kMinHeaderBytes,
                        size = load<std::uint16_t>(kHeaderBytes);
    if (size < least)
      fail(kHeaderBytes, "a header of " + std::to_string(size) +
                             " bytes is too short for version 1." + std::to_string(minor) + ": " +
                             std::to_string(least) + " bytes");
    header_.data = load<std::uint32_t>(kDataOffset);
    if (header_.data < size) fail(kDataOffset, "the point records start inside the header");
    if (header_.data > bytes_.size())
      fail(kDataOffset, "the point records start beyond the end of the file");
  }

  void read_count() {
    const std::uint64_t legacy = load<std::uint32_t>(kLegacyPoints);
    const bool is_long = header_.minor_version >= 4;
    const std::uint64_t points = is_long ? load<std::uint64_t>(kPoints) : 0;
    // Formats 6 to 10 have the long count only. Some writers put the largest number, or what fits,
    // into the legacy one.
    const bool uses_legacy = header_.format < 6 ? legacy != 0 : points == 0;
    header_.points = uses_legacy ? legacy : points;
    header_.has_two_counts = header_.format < 6 && legacy != 0 && points != 0 && points != legacy;
    const std::uint64_t room = (bytes_.size() - header_.data) / header_.record_bytes;
    if (header_.points > room)
      fail(uses_legacy ? kLegacyPoints : kPoints, "the file ends after " + std::to_string(room) +
                                                      " of " + std::to_string(header_.points) +
                                                      " points");
  }

  void read_scales() {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t step = sizeof(double) * static_cast<std::size_t>(axis);
      const auto scale = load<double>(kScale + step), offset = load<double>(kOffset + step);
      constexpr double kMost = 2147483648.0;  // The greatest size of an integer of a record.
      if (scale == 0 || !std::isfinite(std::fabs(scale) * kMost + std::fabs(offset)))
        fail(kScale + step, "scale and offset do not give finite coordinates");
      header_.scale[axis] = scale;
      header_.offset[axis] = offset;
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  LasHeader header_;
};

}  // namespace

LasHeader parse_las_header(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).parse();
}

int las_color_offset(int format) {
  constexpr int offsets[] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  return offsets[format];
}

}  // namespace voxdag
