#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/color_range.hpp"
#include "voxdag/formats/imports/points/load_value.hpp"
#include "voxdag/formats/imports/points/lzf_stream.hpp"
#include "voxdag/formats/imports/points/pcd_header.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/readers/chunks.hpp"

namespace voxdag {
namespace {

/// Compressed points that are in memory at a time.
constexpr std::size_t kBlock = 4096;
/// Before compressed data: its size, and that of the decompressed body. 32 bits each.
constexpr std::size_t kSizes = 8;

double load_number(const PcdField& field, const char* p) {
  const std::uint64_t size = field.size;
  if (field.type == 'F') return size == 4 ? load_value<float>(p) : load_value<double>(p);
  if (field.type == 'I') {
    if (size == 1) return load_value<std::int8_t>(p);
    if (size == 2) return load_value<std::int16_t>(p);
    if (size == 4) return load_value<std::int32_t>(p);
    return static_cast<double>(load_value<std::int64_t>(p));
  }
  if (size == 1) return load_value<std::uint8_t>(p);
  if (size == 2) return load_value<std::uint16_t>(p);
  if (size == 4) return load_value<std::uint32_t>(p);
  return static_cast<double>(load_value<std::uint64_t>(p));
}

/// Returns the packed colour of a number of text.
std::uint32_t parse_color(std::string_view token) {
  std::int64_t integer = 0;
  if (parse_int(token, integer)) {
    if (integer < std::numeric_limits<std::int32_t>::min() ||
        integer > std::numeric_limits<std::uint32_t>::max())
      throw Fault{token.data(), "colour " + in_quotes(token) + " has more than 32 bits"};
    return static_cast<std::uint32_t>(integer);
  }
  float packed = 0;
  if (!parse_float(token, packed))
    throw Fault{token.data(), "colour " + in_quotes(token) + " is not a number"};
  // Text keeps no bits of a NaN.
  return std::isnan(packed) ? 0 : bits_of_float(packed);
}

/// Returns the kind of channel for the numbers of a field.
ChannelKind kind_of_field(const PcdField& field) {
  if (field.type == 'F') return ChannelKind::kF32;
  const bool is_signed = field.type == 'I';
  if (field.size == 1) return kind_of(is_signed ? ValueType::kInt8 : ValueType::kUint8);
  if (field.size == 2) return kind_of(is_signed ? ValueType::kInt16 : ValueType::kUint16);
  return ChannelKind::kI32;
}

/// The values of a point: three coordinates, then a packed colour, 0xAARRGGBB, or red, green and
/// blue, then the label, then the channels.
using PcdValues = std::array<double, 7 + kMaxChannels>;

class PcdPoints : public VoxelSource {
 public:
  PcdPoints(const std::filesystem::path& path, const LabelRequest& labels,
            const std::vector<ChannelRequest>& channels)
      : file_(path, MappedFile::Access::kSequential),
        source_{file_.text(), path.string(), {}, &file_, {}},
        header_(parse_pcd_header(source_.bytes, source_.name)) {
    for (const char* const axis : {"x", "y", "z"}) {
      const int found = header_.find(axis);
      if (found < 0) throw fail_in_header("has no field '" + std::string(axis) + "'");
      used_.push_back(header_.fields[found]);
      if (used_.back().count != 1)
        throw fail_in_header("field '" + std::string(axis) + "' has " +
                             std::to_string(used_.back().count) + " values instead of one");
    }
    for (const char* const name : {"rgb", "rgba"}) {
      const int found = header_.find(name);
      if (found < 0 || used_.size() > 3) continue;
      const PcdField& field = header_.fields[found];
      if (field.count == 1 && field.size == 4) used_.push_back(field);
    }
    if (header_.data == PcdData::kCompressed && header_.points > 0) find_compressed();
    color_fields_ = used_.size() - 3;
    if (color_fields_ == 0) find_components();
    const auto name_of = [&](std::size_t i) { return header_.fields[i].name; };
    if (labels) {
      const std::size_t found = find_label_field(*labels, header_.fields.size(), name_of);
      if (header_.fields[found].count != 1)
        throw fail_in_header("the field of labels has more than one value");
      used_.push_back(header_.fields[found]);
      has_labels_ = true;
    }
    if (channels.size() > kMaxChannels) throw fail_in_header("at most 16 channels are read");
    for (const std::size_t found : find_channel_fields(channels, header_.fields.size(), name_of)) {
      const PcdField& field = header_.fields[found];
      if (field.count != 1)
        throw fail_in_header("field " + in_quotes(field.name) + " has " +
                             std::to_string(field.count) + " values, and a channel has one number");
      channels_.push_back(channel_spec(channels[channels_.size()], kind_of_field(field)));
      used_.push_back(field);
    }
  }

  bool has_points() const override { return true; }
  bool has_colors() const override { return color_fields_ > 0; }
  bool has_labels() const override { return has_labels_; }
  std::vector<ChannelSpec> channels() const override { return channels_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  CoordinateError coordinate_error() const override {
    const bool has_floats = std::any_of(used_.begin(), used_.begin() + 3, [](const PcdField& f) {
      return f.type == 'F' && f.size == 4;
    });
    return has_floats ? kFloatCoordinates : CoordinateError{};
  }
  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels points(visit);
    for_each_point([&](const PcdValues& values) { add(points, values); });
    points.finish();
  }

 private:
  /// Returns whether a field is a packed colour.
  bool is_packed(std::size_t used) const { return color_fields_ == 1 && used == 3; }

  Error fail_in_header(const std::string& reason) const { return {source_.name, "header", reason}; }

  /// Finds colours in fields r, g and b: of bytes, 16 bits, or real numbers to 1 or 255.
  void find_components() {
    for (const char* const name : {"r", "g", "b"}) {
      const int found = header_.find(name);
      if (found < 0 || header_.fields[found].count != 1) return used_.resize(3);
      used_.push_back(header_.fields[found]);
    }
    color_fields_ = 3;
    const bool are_real = used_[3].type == 'F';
    color_range_ = 255;
    if (!are_real && used_[3].size != 2) return;
    double greatest = 0;
    for_each_point([&](const PcdValues& values) {
      greatest = std::max({greatest, values[3], values[4], values[5]});
    });
    color_range_ = color_range(are_real, greatest, warnings_);
  }

  /// Calls use(point) for all points.
  template <class Use>
  void for_each_point(const Use& use) const {
    const bool is_text = header_.data == PcdData::kAscii;
    try {
      if (is_text)
        visit_text(use);
      else if (header_.data == PcdData::kBinary)
        visit_binary(use);
      else
        visit_compressed(use);
    } catch (const Fault& fault) {
      throw_fault(source_, fault, is_text ? '\n' : kNoLines);
    }
  }

  void add(BatchedVoxels& points, const PcdValues& values) const {
    const std::size_t label = 3 + color_fields_, first_channel = label + (has_labels_ ? 1 : 0);
    const Vec3d place{values[0], values[1], values[2]};
    if (has_labels_) points.add_label(label_of(values[label]));
    for (std::size_t c = first_channel; c < used_.size(); ++c) points.add_channel(values[c]);
    if (!has_colors()) return points.add(place);
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c)
      color[c] =
          color_fields_ > 1
              ? color_byte(values[3 + c] * (1 / color_range_))
              : static_cast<std::uint8_t>(static_cast<std::uint32_t>(values[3]) >> (16 - 8 * c));
    points.add(place, color);
  }

  double load_field(std::size_t used, const char* at) const {
    return is_packed(used) ? load_value<std::uint32_t>(at) : load_number(used_[used], at);
  }

  template <class Use>
  void visit_text(const Use& use) const {
    std::string_view text = source_.bytes.substr(header_.body);
    PassedPages pages(file_, text.data());
    for (std::uint64_t i = 0; i < header_.points;) {
      if (text.empty())
        throw Fault{text.data(), "the file ends after " + std::to_string(i) + " of " +
                                     std::to_string(header_.points) + " points"};
      const std::string_view line = next_line(text, '\n');
      pages.pass(text.data());
      if (trim(line).empty()) continue;
      use(parse_point(line));
      ++i;
    }
  }

  PcdValues parse_point(std::string_view line) const {
    PcdValues values{};
    for (std::uint64_t value = 0; value < header_.point_values; ++value) {
      const std::string_view token = next_token(line);
      if (token.empty())
        throw Fault{line.data(), "the point has " + std::to_string(value) + " of " +
                                     std::to_string(header_.point_values) + " values"};
      for (std::size_t used = 0; used < used_.size(); ++used) {
        if (used_[used].ordinal != value) continue;
        if (is_packed(used))
          values[used] = parse_color(token);
        else if (!parse_float(token, values[used]))
          throw Fault{token.data(), kind_of_value(used) + in_quotes(token) + " is not a number"};
      }
    }
    const std::string_view extra = next_token(line);
    if (!extra.empty())
      throw Fault{extra.data(), "the point has " + in_quotes(extra) + " after its last value"};
    return values;
  }
  std::string kind_of_value(std::size_t used) const {
    if (used < 3) return "coordinate ";
    if (used < 3 + color_fields_) return "colour ";
    return has_labels_ && used == 3 + color_fields_ ? "label " : "channel ";
  }

  template <class Use>
  void visit_binary(const Use& use) const {
    const char* at = source_.bytes.data() + header_.body;
    PassedPages pages(file_, at);
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      PcdValues values{};
      for (std::size_t used = 0; used < used_.size(); ++used)
        values[used] = load_field(used, at + used_[used].offset);
      use(values);
      at += header_.point_bytes;
      pages.pass(at);
    }
  }

  /// Checks the sizes of the compressed data.
  void find_compressed() {
    const std::string_view body = source_.bytes.substr(header_.body);
    if (body.size() < kSizes)
      throw source_.error_at_byte(header_.body, "the file ends before its compressed data");
    const std::uint64_t packed = load_value<std::uint32_t>(body.data()),
                        unpacked = load_value<std::uint32_t>(body.data() + 4);
    if (packed > body.size() - kSizes)
      throw source_.error_at_byte(header_.body, "the file ends inside its compressed data");
    if (unpacked / header_.point_bytes != header_.points || unpacked % header_.point_bytes != 0)
      throw source_.error_at_byte(
          header_.body + 4, "compressed data of " + std::to_string(unpacked) + " bytes are not " +
                                std::to_string(header_.points) + " points of " +
                                std::to_string(header_.point_bytes) + " bytes");
    if (unpacked > LzfStream::kMaxRatio * packed)
      throw source_.error_at_byte(header_.body, std::to_string(packed) +
                                                    " compressed bytes cannot hold " +
                                                    std::to_string(unpacked) + " bytes");
    compressed_ = body.substr(kSizes, packed);
    is_stored_ = packed == unpacked && !is_lzf(unpacked);
  }

  /// Returns whether the data are `bytes` compressed bytes. A writer whose data did not shrink may
  /// have stored them as they were.
  bool is_lzf(std::uint64_t bytes) const {
    try {
      LzfStream(compressed_).skip(bytes);
      return true;
    } catch (const Fault&) {
      return false;
    }
  }

  /// Decompresses as often as there are fields to read, so that no field is held in memory.
  template <class Use>
  void visit_compressed(const Use& use) const {
    if (header_.points == 0) return;
    std::vector<LzfStream> streams;
    std::vector<std::vector<char>> columns;
    for (const PcdField& field : used_) {
      streams.emplace_back(compressed_);
      if (!is_stored_) streams.back().skip(field.offset * header_.points);
      columns.emplace_back(kBlock * field.size);
    }
    for (std::uint64_t first = 0; first < header_.points; first += kBlock) {
      const std::size_t count = std::min<std::uint64_t>(kBlock, header_.points - first);
      for (std::size_t used = 0; used < used_.size(); ++used) {
        const PcdField& field = used_[used];
        char* const column = columns[used].data();
        if (is_stored_)
          compressed_.copy(column, count * field.size,
                           field.offset * header_.points + first * field.size);
        else
          streams[used].read(column, count * field.size);
      }
      for (std::size_t i = 0; i < count; ++i) {
        PcdValues values{};
        for (std::size_t used = 0; used < used_.size(); ++used)
          values[used] = load_field(used, columns[used].data() + i * used_[used].size);
        use(values);
      }
    }
  }

  MappedFile file_;
  MeshSource source_;
  PcdHeader header_;
  std::vector<PcdField> used_;    ///< The fields of the values.
  std::size_t color_fields_ = 0;  ///< 1: packed.
  bool has_labels_ = false;
  std::vector<ChannelSpec> channels_;
  double color_range_ = 1;       ///< The greatest component of r, g and b.
  std::string_view compressed_;  ///< None if no point is compressed.
  std::vector<std::string> warnings_;
  bool is_stored_ = false;  ///< The data of a compressed file are as they were.
};

}  // namespace

std::unique_ptr<VoxelSource> open_pcd_points(const std::filesystem::path& path,
                                             const LabelRequest& labels,
                                             const std::vector<ChannelRequest>& channels) {
  return std::make_unique<PcdPoints>(path, labels, channels);
}

}  // namespace voxdag
