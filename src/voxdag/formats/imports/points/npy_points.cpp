#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/npy_type.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/color_range.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"

namespace voxdag {
namespace {

/// Where a number of each row lies.
struct Column {
  NpyType type;
  std::uint64_t offset = 0;  ///< Of the first row, in bytes.

  double load(const char* row) const { return load_number(type, row + offset); }
};

/// A field of a structured array: items of one type, next to each other.
struct Field {
  std::string name;  ///< In small letters.
  NpyType type;
  std::uint64_t offset = 0, items = 1;
};

/// Parses the type of a structured array, "[('voxel', '<i4', (3,)), ('color', '|u1', (3,))]".
class FieldParser {
 public:
  explicit FieldParser(std::string_view text) : text_(text) {}

  /// Returns the fields whose types have values; `row_bytes` is the size of all. Returns nothing
  /// for a type that is not such a list.
  std::optional<std::vector<Field>> parse(std::uint64_t& row_bytes) {
    std::vector<Field> fields;
    row_bytes = 0;
    if (!take('[')) return std::nullopt;
    while (!take(']')) {
      Field field;
      std::string type;
      if (!take('(') || !take_string(field.name) || !take(',') || !take_string(type))
        return std::nullopt;
      if (take(',') && take('(')) {
        while (!take(')')) {
          std::uint64_t size = 0;
          if (!take_number(size) || size > kMaxItems / field.items) return std::nullopt;
          field.items *= size;
          take(',');
        }
      }
      if (!take(')')) return std::nullopt;
      take(',');
      const std::optional<std::uint64_t> bytes = bytes_of_npy_type(type);
      if (!bytes || row_bytes > kMaxItems) return std::nullopt;
      field.offset = row_bytes;
      row_bytes += *bytes * field.items;
      field.name = lower_case(field.name);
      if (const std::optional<NpyType> number = parse_npy_type(type)) {
        field.type = *number;
        fields.push_back(std::move(field));
      }
    }
    return fields;
  }

 private:
  static constexpr std::uint64_t kMaxItems = std::uint64_t{1} << 24;  ///< Far more than in files.

  bool take(char wanted) {
    skip_blanks();
    if (!text_.starts_with(wanted)) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool take_string(std::string& value) {
    if (!take('\'')) return false;
    const std::size_t end = text_.find('\'');
    if (end == text_.npos) return false;
    value = text_.substr(0, end);
    text_.remove_prefix(end + 1);
    return true;
  }
  bool take_number(std::uint64_t& value) {
    skip_blanks();
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) return false;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return true;
  }
  void skip_blanks() {
    while (text_.starts_with(' ')) text_.remove_prefix(1);
  }

  std::string_view text_;
};

/// Returns three columns: a field of three items with one of the names of `vectors`, or three
/// fields with the names of one of `scalars`. Returns none if there are none.
std::vector<Column> find_columns(const std::vector<Field>& fields,
                                 std::initializer_list<std::string_view> vectors,
                                 std::initializer_list<std::array<std::string_view, 3>> scalars) {
  const auto find = [&](std::string_view name) {
    return std::find_if(fields.begin(), fields.end(),
                        [&](const Field& field) { return field.name == name; });
  };
  for (const std::string_view name : vectors) {
    const auto field = find(name);
    if (field == fields.end() || field->items < 3 || field->items > 4) continue;
    std::vector<Column> columns;
    for (std::uint64_t i = 0; i < 3; ++i)
      columns.push_back({field->type, field->offset + i * bytes_of(field->type.value)});
    return columns;
  }
  for (const auto& names : scalars) {
    std::vector<Column> columns;
    for (const std::string_view name : names)
      if (const auto field = find(name); field != fields.end() && field->items == 1)
        columns.push_back({field->type, field->offset});
    if (columns.size() == 3) return columns;
  }
  return {};
}

class NpyPoints : public VoxelSource {
 public:
  NpyPoints(const std::filesystem::path& path, const NpyStart& start, const LabelRequest& labels,
            const std::vector<ChannelRequest>& channels)
      : name_(path.string()), file_(path, MappedFile::Access::kSequential), begin_(start.data) {
    find_rows(start.header, labels, channels);
    is_real_ = std::any_of(places_.begin(), places_.end(),
                           [](const Column& column) { return is_real(column.type.value); });
    const std::uint64_t size = file_.text().size(), end = begin_ + rows_ * row_bytes_;
    if (size < end)
      throw Error(
          name_, ErrorPlace::byte(size),
          "truncated: " + std::to_string(rows_) + " rows need " + std::to_string(end) + " bytes");
    if (size > end)
      warnings_.push_back("bytes after the array are left out: " + std::to_string(size - end));
    if (!colors_.empty()) find_color_scale();
  }

  bool has_points() const override { return is_real_; }
  bool has_colors() const override { return !colors_.empty(); }
  bool has_labels() const override { return label_.has_value(); }
  std::vector<ChannelSpec> channels() const override { return channels_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  CoordinateError coordinate_error() const override {
    CoordinateError error;
    for (const Column& column : places_)
      if (column.type.value == ValueType::kHalf)
        error.relative = 0x1p-11;
      else if (column.type.value == ValueType::kFloat)
        error.relative = std::max(error.relative, kFloatCoordinates.relative);
    return error;
  }
  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels voxels(visit);
    const char* row = file_.text().data() + begin_;
    PassedPages pages(file_, row);
    for (std::uint64_t i = 0; i < rows_; ++i, row += row_step_) {
      const Vec3d place{places_[0].load(row), places_[1].load(row), places_[2].load(row)};
      if (label_) voxels.add_label(label_of(label_->load(row)));
      for (const Column& column : channel_columns_) voxels.add_channel(column.load(row));
      if (colors_.empty())
        voxels.add(place);
      else
        voxels.add(place, color_of(row));
      if (!is_by_columns_) pages.pass(row);
    }
    voxels.finish();
  }

 private:
  [[noreturn]] void refuse(const std::string& found) const {
    throw Error(
        name_, "header",
        "is no array of shape (N, 3) of numbers, nor one of rows with the fields x, y and z: "
        "it is " +
            found);
  }

  void find_rows(const NpyHeader& header, const LabelRequest& labels,
                 const std::vector<ChannelRequest>& channels) {
    if (header.shape.empty()) refuse("a single number");
    rows_ = header.shape[0];
    if (header.dtype.starts_with('[')) {
      find_fields(header, labels, channels);
    } else {
      const std::optional<NpyType> type = parse_npy_type(header.dtype);
      if (!type || header.dtype.ends_with("b1")) refuse("of type " + in_quotes(header.dtype));
      if (header.shape.size() != 2 || header.shape[1] != 3) {
        std::string shape;
        for (const std::uint64_t side : header.shape)
          shape += (shape.empty() ? "" : " x ") + std::to_string(side);
        refuse("of shape " + shape);
      }
      const std::uint64_t item = bytes_of(type->value);
      is_by_columns_ = header.fortran_order;
      row_bytes_ = 3 * item;
      row_step_ = is_by_columns_ ? item : row_bytes_;
      if (labels) throw Error(name_, "header", "has rows without fields, so without labels");
      if (!channels.empty())
        throw Error(name_, "header", "has rows without fields, so without channels");
      if (rows_ > kMaxRows) refuse("of " + std::to_string(rows_) + " rows");
      for (std::uint64_t axis = 0; axis < 3; ++axis)
        places_.push_back({*type, axis * item * (is_by_columns_ ? rows_ : 1)});
    }
    if (rows_ > kMaxRows) refuse("of " + std::to_string(rows_) + " rows");
  }

  void find_fields(const NpyHeader& header, const LabelRequest& labels,
                   const std::vector<ChannelRequest>& channels) {
    if (header.shape.size() != 1) refuse("a structured array of more than one axis");
    const auto fields = FieldParser(header.dtype).parse(row_bytes_);
    if (!fields) refuse("of type " + in_quotes(header.dtype));
    row_step_ = row_bytes_;
    places_ = find_columns(*fields, {"voxel", "position", "xyz", "point", "points", "coords"},
                           {{"x", "y", "z"}});
    if (places_.empty()) refuse("of type " + in_quotes(header.dtype));
    colors_ = find_columns(*fields, {"color", "colors", "rgb", "rgba"},
                           {{"red", "green", "blue"}, {"r", "g", "b"}});
    const auto name_of = [&](std::size_t i) { return (*fields)[i].name; };
    const std::vector<std::size_t> found = find_channel_fields(channels, fields->size(), name_of);
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const Field& field = (*fields)[found[i]];
      if (field.items != 1)
        throw Error(
            name_, "header",
            "the field " + in_quotes(field.name) + " is not one number in each row, so no channel");
      channels_.push_back(channel_spec(channels[i], kind_of(field.type.value)));
      channel_columns_.push_back({field.type, field.offset});
    }
    if (!labels) return;
    const Field& field = (*fields)[find_label_field(*labels, fields->size(), name_of)];
    if (field.items != 1) throw Error(name_, "header", "the labels are not one number in each row");
    label_ = Column{field.type, field.offset};
  }

  /// Finds the range of the colours: 255 of bytes; see color_range() for 16 bits and real numbers.
  void find_color_scale() {
    const ValueType type = colors_[0].type.value;
    if (is_real(type) || type == ValueType::kUint16) {
      double greatest = 0;
      const char* row = file_.text().data() + begin_;
      PassedPages pages(file_, row);
      for (std::uint64_t i = 0; i < rows_; ++i, row += row_step_) {
        for (const Column& column : colors_)
          if (const double value = column.load(row); std::isfinite(value))
            greatest = std::max(greatest, value);
        pages.pass(row);
      }
      color_scale_ = 1 / color_range(is_real(type), greatest, warnings_);
    } else if (type != ValueType::kUint8) {
      warnings_.emplace_back(
          "its colours are left out: they are no bytes, 16 bits or real numbers");
      colors_.clear();
    }
  }

  Rgb8 color_of(const char* row) const {
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c) color[c] = color_byte(colors_[c].load(row) * color_scale_);
    return color;
  }

  static constexpr std::uint64_t kMaxRows = std::uint64_t{1} << 38;

  std::string name_;
  MappedFile file_;
  std::uint64_t begin_, rows_ = 0, row_bytes_ = 0;
  std::uint64_t row_step_ = 0;  ///< From a number of a column to the next one.
  bool is_by_columns_ = false;  ///< The order is Fortran's.
  bool is_real_ = false;
  std::vector<Column> places_, colors_;  ///< Three, or no colours.
  std::optional<Column> label_;
  std::vector<ChannelSpec> channels_;
  std::vector<Column> channel_columns_;
  double color_scale_ = 1.0 / 255;  ///< Maps a component to 0..1.
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_npy_points(const std::filesystem::path& path,
                                             const NpyStart& start, const LabelRequest& labels,
                                             const std::vector<ChannelRequest>& channels) {
  return std::make_unique<NpyPoints>(path, start, labels, channels);
}

}  // namespace voxdag
