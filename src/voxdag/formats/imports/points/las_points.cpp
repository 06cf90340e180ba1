/// Reads LAS files (ASPRS, LAS Specification 1.0 to 1.5).
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/load_value.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"

namespace voxdag {
namespace {

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

/// Bytes of a record, per format.
constexpr std::uint64_t kRecordBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// Offsets of fields, in bytes.
constexpr std::size_t kMajorVersion = 24, kMinorVersion = 25, kHeaderBytes = 94, kDataOffset = 96,
                      kFormat = 104, kRecordLength = 105, kLegacyPoints = 107, kScale = 131,
                      kOffset = 155, kPoints = 247;

/// Headers end with the bounds. Versions 1.3 to 1.5 add fields, of which the reader needs the count
/// of 64 bits only; some writers of 1.3 leave them out.
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
      constexpr double kMax = 2147483648.0;  // The greatest size of an integer of a record.
      if (scale == 0 || !std::isfinite(std::fabs(scale) * kMax + std::fabs(offset)))
        fail(kScale + step, "scale and offset do not give finite coordinates");
      header_.scale[axis] = scale;
      header_.offset[axis] = offset;
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  LasHeader header_;
};

/// Parses the header and checks it: the file has all its records, and all coordinates are finite.
/// If the two counts of version 1.4 differ, a legacy count other than 0 wins, as the specification
/// says.
/// Throws Error(name, byte, reason).
LasHeader parse_las_header(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).parse();
}

/// Returns the offset in a record of red, green and blue, 16 bits each; 0 if the format has none.
int las_color_offset(int format) {
  constexpr int offsets[] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  return offsets[format];
}

/// The classes of the specification. Formats 0 to 5 have the first 13.
constexpr std::string_view kClasses[] = {"never classified",
                                         "unclassified",
                                         "ground",
                                         "low vegetation",
                                         "medium vegetation",
                                         "high vegetation",
                                         "building",
                                         "low point",
                                         "model key point",
                                         "water",
                                         "rail",
                                         "road surface",
                                         "overlap",
                                         "wire guard",
                                         "wire conductor",
                                         "transmission tower",
                                         "wire connector",
                                         "bridge deck",
                                         "high noise",
                                         "overhead structure",
                                         "ignored ground",
                                         "snow",
                                         "temporal exclusion"};

/// A field of a record with labels: its name, and its offsets in formats 0 to 5 and from 6 on.
struct LasLabelField {
  std::string_view name;
  int offset, long_offset, bytes;
};
constexpr LasLabelField kLabelFieldsOfLas[] = {
    {"classification", 15, 16, 1}, {"user_data", 17, 17, 1}, {"point_source_id", 18, 20, 2}};

/// The fields of channels: the intensity, 16 bits at this offset, and those of labels.
constexpr std::size_t kIntensity = 12;
constexpr std::string_view kChannelFieldsOfLas[] = {"intensity", "classification", "user_data",
                                                    "point_source_id"};

class LasPoints : public VoxelSource {
 public:
  LasPoints(const std::filesystem::path& path, const LabelRequest& labels,
            const std::vector<ChannelRequest>& channels)
      : name_(path.string()),
        file_(path, MappedFile::Access::kSequential),
        header_(parse_las_header(file_.text(), name_)),
        color_(las_color_offset(header_.format)) {
    if (color_ > 0) color_shift_ = has_wide_color() ? 8 : 0;
    if (labels)
      label_ = &kLabelFieldsOfLas[find_label_field(
          *labels, std::size(kLabelFieldsOfLas),
          [](std::size_t i) { return kLabelFieldsOfLas[i].name; })];
    const auto name_of = [](std::size_t i) { return kChannelFieldsOfLas[i]; };
    channel_fields_ = find_channel_fields(channels, std::size(kChannelFieldsOfLas), name_of);
    for (std::size_t i = 0; i < channels.size(); ++i)
      channels_.push_back(channel_spec(
          channels[i], is_wide(channel_fields_[i]) ? ChannelKind::kU16 : ChannelKind::kU8));
  }

  bool has_points() const override { return true; }
  bool has_colors() const override { return color_ > 0; }
  bool has_labels() const override { return label_ != nullptr; }
  std::map<Label, std::string> label_names() const override {
    std::map<Label, std::string> names;
    if (label_ == &kLabelFieldsOfLas[0])
      for (std::size_t i = 0; i < (header_.format < 6 ? 13 : std::size(kClasses)); ++i)
        names.emplace(static_cast<Label>(i), kClasses[i]);
    return names;
  }
  std::vector<ChannelSpec> channels() const override { return channels_; }
  /// Counts the rounding of add(): a product and a sum.
  CoordinateError coordinate_error() const override {
    CoordinateError error{0x1p-51, {}};
    for (int axis = 0; axis < 3; ++axis)
      error.absolute[axis] = 0x1p-52 * std::abs(header_.offset[axis]);
    return error;
  }
  std::vector<std::string> warnings() const override {
    if (!header_.has_two_counts) return {};
    return {"the header has two counts of points; the legacy one, " +
            std::to_string(header_.points) + ", is used"};
  }
  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels points(visit);
    for_each_record([&](const char* record) {
      if (!is_withheld(record)) add(points, record);
      return true;
    });
    points.finish();
  }

 private:
  /// Calls on_record(record) until it returns false.
  template <class OnRecord>
  void for_each_record(const OnRecord& on_record) const {
    const char* record = file_.text().data() + header_.data;
    PassedPages pages(file_, record);
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      if (!on_record(record)) return;
      record += header_.record_bytes;
      pages.pass(record);
    }
  }

  /// The flags of version 1.0 belong to the classification.
  bool is_withheld(const char* record) const {
    const auto flags = load_value<std::uint8_t>(record + 15);
    if (header_.format >= 6) return (flags & 4) != 0;
    return header_.minor_version > 0 && (flags & 128) != 0;
  }

  static bool is_wide(std::size_t channel_field) {
    return channel_field == 0 || kLabelFieldsOfLas[channel_field - 1].bytes == 2;
  }
  double channel_in(const char* record, std::size_t field) const {
    if (field == 0) return load_value<std::uint16_t>(record + kIntensity);
    return static_cast<double>(label_in(record, kLabelFieldsOfLas[field - 1]));
  }

  Label label_in(const char* record, const LasLabelField& field) const {
    const bool is_long = header_.format >= 6;
    const char* const at = record + (is_long ? field.long_offset : field.offset);
    if (field.bytes == 2) return load_value<std::uint16_t>(at);
    const auto value = load_value<std::uint8_t>(at);
    // In formats 0 to 5, bits 5 to 7 are flags; in version 1.0 they were not.
    const bool has_flags = &field == &kLabelFieldsOfLas[0] && !is_long && header_.minor_version > 0;
    return has_flags ? value & 31 : value;
  }

  /// Returns whether a component of a colour needs more than 8 bits.
  bool has_wide_color() const {
    bool is_wide = false;
    for_each_record([&](const char* record) {
      for (int c = 0; c < 3; ++c)
        is_wide |= load_value<std::uint16_t>(record + color_ + 2 * c) > 255;
      return !is_wide;
    });
    return is_wide;
  }

  void add(BatchedVoxels& points, const char* record) const {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] =
          load_value<std::int32_t>(record + 4 * axis) * header_.scale[axis] + header_.offset[axis];
    if (has_labels()) points.add_label(label_in(record, *label_));
    for (const std::size_t field : channel_fields_) points.add_channel(channel_in(record, field));
    if (!has_colors()) return points.add(point);
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = static_cast<std::uint8_t>(load_value<std::uint16_t>(record + color_ + 2 * c) >>
                                           color_shift_);
    points.add(point, color);
  }

  std::string name_;
  MappedFile file_;
  LasHeader header_;
  int color_;  ///< Offset in a record; 0: none.
  int color_shift_ = 0;
  const LasLabelField* label_ = nullptr;
  std::vector<ChannelSpec> channels_;
  std::vector<std::size_t> channel_fields_;  ///< In kChannelFieldsOfLas.
};

}  // namespace

std::unique_ptr<VoxelSource> open_las_points(const std::filesystem::path& path,
                                             const LabelRequest& labels,
                                             const std::vector<ChannelRequest>& channels) {
  return std::make_unique<LasPoints>(path, labels, channels);
}

}  // namespace voxdag
