#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;
/// Points that decide whether the columns behind the coordinates are colours.
constexpr std::size_t kSampledPoints = 4096;
constexpr std::size_t kCoordinates = 3, kValues = 6;  ///< Coordinates, then a colour.

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; }
bool is_comma(char c) { return c == ',' || c == ';'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Cuts a line into fields. Beside a comma or semicolon, a field may be empty.
class Fields {
 public:
  explicit Fields(std::string_view line) : rest_(line) {}

  /// Sets `field` to the next one. Returns false if there is none.
  bool next(std::string_view& field) {
    skip_blanks();
    if (rest_.empty() && !is_after_comma_) return false;
    std::size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end]) && !is_comma(rest_[end])) ++end;
    field = rest_.substr(0, end);
    rest_.remove_prefix(end);
    skip_blanks();
    is_after_comma_ = !rest_.empty() && is_comma(rest_[0]);
    if (is_after_comma_) rest_.remove_prefix(1);
    return true;
  }

 private:
  void skip_blanks() {
    std::size_t blanks = 0;
    while (blanks < rest_.size() && is_blank(rest_[blanks])) ++blanks;
    rest_.remove_prefix(blanks);
  }
  std::string_view rest_;
  bool is_after_comma_ = false;
};

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  std::string_view field;
  for (Fields rest(line); rest.next(field);) fields.push_back(field);
  return fields;
}

/// Returns whether Windows wrote a number that is not finite: "1.#QNAN", "-1.#IND", "1.#INF00".
bool is_windows_nan(std::string_view field) {
  const std::size_t sign = field.rfind('#');
  return sign != field.npos && sign > 1 && field[sign - 1] == '.' && field[sign - 2] == '1';
}

/// Parses a number. Numbers of is_windows_nan() are NaN.
bool parse_number(std::string_view field, double& value) {
  if (parse_float(field, value)) return true;
  value = std::numeric_limits<double>::quiet_NaN();
  return is_windows_nan(field);
}

/// Removes a comment, which begins with # or //, from a line.
std::string_view without_comment(std::string_view line) {
  std::size_t end = line.find('#');
  while (end != line.npos && is_windows_nan(line.substr(0, end + 1))) end = line.find('#', end + 1);
  return line.substr(0, std::min(end, line.find("//")));
}

bool is_byte_text(std::string_view field) {
  double value = 0;
  return std::all_of(field.begin(), field.end(), is_digit) && parse_float(field, value) &&
         value <= 255;
}

/// Returns whether a line has commas inside numbers, and another character between them.
bool has_decimal_commas(std::string_view line) {
  const std::string_view body = trim(line);
  if (body.find_first_of(" \t;") == body.npos) return false;
  for (std::size_t at = body.find(','); at != body.npos; at = body.find(',', at + 1))
    if (at > 0 && at + 1 < body.size() && is_digit(body[at - 1]) && is_digit(body[at + 1]))
      return true;
  return false;
}

/// Returns which value the name of a column stands for; kValues for another one.
std::size_t value_of_name(std::string_view name) {
  const std::string lower = lower_case(name);
  constexpr std::string_view kNames[][kValues] = {
      {"x", "y", "z", "r", "g", "b"},
      {"points:0", "points:1", "points:2", "red", "green", "blue"},
      {"points_0", "points_1", "points_2", "rgb:0", "rgb:1", "rgb:2"},
      {"", "", "", "r8", "g8", "b8"},
      {"", "", "", "rf", "gf", "bf"}};
  if (lower.empty()) return kValues;
  for (const auto& names : kNames)
    for (std::size_t value = 0; value < kValues; ++value)
      if (lower == names[value]) return value;
  return kValues;
}

class XyzPoints : public VoxelSource {
 public:
  XyzPoints(const std::filesystem::path& path, const LabelRequest& labels,
            const std::vector<ChannelRequest>& channels)
      : name_(path.string()), file_(path, MappedFile::Access::kSequential) {
    if (file_.text().starts_with("\xFF\xFE") || file_.text().starts_with("\xFE\xFF"))
      throw Error(name_, "", "is a text in UTF-16: save it in UTF-8");
    find_header();
    if (labels) label_column_ = column_of(*labels);
    for (const ChannelRequest& channel : channels) {
      if (channel.field.empty()) throw Error("", "", "a channel needs the name of a field");
      channel_columns_.push_back(column_of(channel.field));
      channels_.push_back(channel_spec(channel, ChannelKind::kF32));
    }
    if (!has_names_) find_colors();
    if (has_colors()) find_color_range();
  }

  bool has_points() const override { return true; }
  bool has_colors() const override { return columns_.size() > kCoordinates; }
  bool has_labels() const override { return label_column_.has_value(); }
  std::vector<ChannelSpec> channels() const override { return channels_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels points(visit);
    PassedPages pages(file_, file_.text().data());
    std::uint64_t announced = 0, count = 0;
    for_each_line([&](std::string_view line, std::uint64_t number) {
      if (const auto more = count_of(line)) {
        announced += *more;
        return true;
      }
      ++count;
      add(points, line, number);
      pages.pass(line.data());
      return true;
    });
    points.finish();
    if (announced != count && announced > 0)
      throw Error(name_, "",
                  "has " + std::to_string(count) + " points, but lines with one number announce " +
                      std::to_string(announced));
  }

 private:
  [[noreturn]] void fail(std::uint64_t line, const std::string& reason) const {
    throw Error(name_, "line " + std::to_string(line), reason);
  }

  /// Calls use(line, number) for the lines with fields, without comments, until it returns false.
  /// Leaves out the header.
  template <class Use>
  void for_each_line(const Use& use) const {
    std::string_view text = without_byte_order_mark(file_.text());
    const char line_end = line_end_of(text);
    for (std::uint64_t number = 1; !text.empty(); ++number) {
      std::string_view line = next_line(text, line_end);
      if (line.size() > kMaxLineBytes) fail(number, "is longer than 1 MiB");
      line = without_comment(line);
      if (number == header_line_ || trim(line).empty()) continue;
      if (!use(line, number)) return;
    }
  }

  /// Finds the names of the columns: in the last comment before the first points, or in a line
  /// that does not begin with a number.
  void find_header() {
    std::string_view text = without_byte_order_mark(file_.text());
    const char line_end = line_end_of(text);
    std::string_view names;
    for (std::uint64_t number = 1; !text.empty(); ++number) {
      std::string_view line = trim(next_line(text, line_end));
      const bool is_comment = line.starts_with('#') || line.starts_with("//");
      while (!line.empty() && (line[0] == '#' || line[0] == '/')) line.remove_prefix(1);
      const std::vector<std::string_view> fields = fields_of(line.substr(0, kMaxLineBytes));
      double ignored = 0;
      if (is_comment) {
        if (has_coordinate_names(fields)) names = line;
        continue;
      }
      if (fields.empty() || count_of(line)) continue;
      const bool has_numbers =
          std::any_of(fields.begin(), fields.end(),
                      [&](std::string_view field) { return parse_number(field, ignored); });
      if (fields[0].empty() ? has_numbers : parse_number(fields[0], ignored)) break;
      if (fields.size() < kCoordinates || header_line_ > 0 || has_numbers)
        fail(number, "number 1, " + in_quotes(fields[0]) + ", is not a number");
      header_line_ = number;
      names = line;
    }
    use_names(fields_of(names));
    for (const std::string_view name : fields_of(names)) names_.emplace_back(name);
  }

  /// Returns a column behind the coordinates, by its name or its number, from 1 on. An empty text
  /// stands for that of the labels.
  std::size_t column_of(const std::string& wanted) const {
    std::int64_t number = 0;
    if (parse_int(wanted, number) && number > static_cast<std::int64_t>(kCoordinates))
      return static_cast<std::size_t>(number) - 1;
    return find_label_field(wanted, names_.size(), [&](std::size_t i) { return names_[i]; });
  }

  /// Adds the label and the channels of the point in a line.
  void add_fields(BatchedVoxels& points, std::string_view line, std::uint64_t number) const {
    if (!label_column_ && channels_.empty()) return;
    const std::vector<std::string_view> fields = fields_of(line);
    const auto value_in = [&](std::size_t column, const char* what) {
      double value = 0;
      if (column >= fields.size() || !parse_number(fields[column], value))
        fail(number, std::string("has no ") + what + " in column " + std::to_string(column + 1));
      return value;
    };
    if (label_column_) points.add_label(label_of(value_in(*label_column_, "label")));
    for (const std::size_t column : channel_columns_)
      points.add_channel(value_in(column, "number"));
  }

  static bool has_coordinate_names(const std::vector<std::string_view>& fields) {
    std::array<bool, kValues + 1> found{};
    for (const std::string_view field : fields) found[value_of_name(field)] = true;
    return found[0] && found[1] && found[2];
  }

  void use_names(const std::vector<std::string_view>& names) {
    if (names.empty()) return;
    if (!has_coordinate_names(names)) {
      warnings_.push_back("its columns " + in_quotes(names[0]) + ", " + in_quotes(names[1]) +
                          " and " + in_quotes(names[2]) + " are taken for x, y and z");
      return;
    }
    std::array<std::optional<std::size_t>, kValues + 1> columns;
    for (std::size_t column = names.size(); column-- > 0;)
      columns[value_of_name(names[column])] = column;
    const bool has_colors = columns[3] && columns[4] && columns[5];
    columns_.clear();
    for (std::size_t value = 0; value < (has_colors ? kValues : kCoordinates); ++value)
      columns_.push_back(*columns[value]);
    has_names_ = true;
  }

  /// Finds colours without names: three columns of whole numbers to 255 behind the coordinates, or
  /// behind a normal, or behind a column more, the intensity of .pts files.
  void find_colors() {
    std::size_t points = 0, fewest = SIZE_MAX;
    constexpr std::size_t kColumns = 9;
    std::array<bool, kColumns> is_byte;
    is_byte.fill(true);
    std::array<double, kColumns> greatest{};
    for_each_line([&](std::string_view line, std::uint64_t) {
      if (count_of(line)) return true;
      const std::vector<std::string_view> fields = fields_of(line);
      fewest = std::min(fewest, fields.size());
      for (std::size_t i = kCoordinates; i < std::min(kColumns, fields.size()); ++i) {
        double value = 0;
        is_byte[i] &= is_byte_text(fields[i]) && parse_float(fields[i], value);
        greatest[i] = std::max(greatest[i], value);
      }
      return ++points < kSampledPoints;
    });
    if (points == 0 || fewest <= kCoordinates) return;
    for (const std::size_t first : {std::size_t{3}, std::size_t{6}, std::size_t{4}}) {
      if (fewest < first + 3) continue;
      const bool are_bytes = is_byte[first] && is_byte[first + 1] && is_byte[first + 2];
      // Normals along an axis are whole numbers, too.
      const bool are_colors =
          are_bytes && std::max({greatest[first], greatest[first + 1], greatest[first + 2]}) > 1;
      if (!are_colors) continue;
      const std::string columns =
          "its columns " + std::to_string(first + 1) + " to " + std::to_string(first + 3);
      if (const std::uint64_t line = line_without_color(first)) {
        warnings_.push_back(columns + " are left out: they have no names, and line " +
                            std::to_string(line) + " has no colour there");
        return;
      }
      for (std::size_t c = 0; c < 3; ++c) columns_.push_back(first + c);
      return;
    }
    if (fewest >= kValues && !label_column_ && channels_.empty())
      warnings_.emplace_back(
          "its columns after the third are left out: they have no names, and are no colours of "
          "whole numbers from 0 to 255");
  }

  /// Returns the first line whose columns [first, first + 3) are no whole numbers from 0 to 255;
  /// 0 if there is none.
  std::uint64_t line_without_color(std::size_t first) const {
    PassedPages pages(file_, file_.text().data());
    std::uint64_t found = 0;
    for_each_line([&](std::string_view line, std::uint64_t number) {
      if (count_of(line)) return true;
      Fields fields(line);
      std::string_view field;
      for (std::size_t column = 0; column < first + 3; ++column)
        if (!fields.next(field) || (column >= first && !is_byte_text(field))) found = number;
      pages.pass(line.data());
      return found == 0;
    });
    return found;
  }

  /// Finds the range of colours: the least of 1, 255 and 65535 that the first points do not exceed.
  void find_color_range() {
    std::size_t points = 0;
    double greatest = 0;
    bool has_points = false;  // "0.0" is no whole number.
    for_each_line([&](std::string_view line, std::uint64_t number) {
      if (count_of(line)) return true;
      const std::array<double, kValues> values = values_of(line, number);
      const std::vector<std::string_view> fields = fields_of(line);
      for (std::size_t c = kCoordinates; c < kValues; ++c) {
        greatest = std::max(greatest, values[c]);
        has_points |= fields[columns_[c]].find('.') != std::string_view::npos;
      }
      return ++points < kSampledPoints;
    });
    color_range_ = greatest > 255 ? 65535 : greatest > 1 || !has_points ? 255 : 1;
  }

  /// Returns the number of points that a line of .pts files announces: its only number.
  static std::optional<std::uint64_t> count_of(std::string_view line) {
    const std::string_view body = trim(line);
    std::int64_t count = 0;
    if (!parse_int(body, count) || count < 0) return std::nullopt;
    return static_cast<std::uint64_t>(count);
  }

  std::array<double, kValues> values_of(std::string_view line, std::uint64_t number) const {
    if (line.find(',') != line.npos && has_decimal_commas(line))
      fail(number,
           "has commas inside numbers and other separators between them: write decimal "
           "points");
    std::array<double, kValues> values{};
    std::size_t found = 0, column = 0;
    Fields fields(line);
    for (std::string_view field; found < columns_.size() && fields.next(field); ++column) {
      for (std::size_t value = 0; value < columns_.size(); ++value) {
        if (columns_[value] != column) continue;
        if (!parse_number(field, values[value]) && (value >= kCoordinates || !field.empty()))
          fail(number, "number " + std::to_string(column + 1) + ", " + in_quotes(field) +
                           ", is not a number");
        ++found;
      }
    }
    if (found < columns_.size())
      fail(number, "has " + std::to_string(column) + " numbers instead of " +
                       (has_colors() || has_names_ ? std::to_string(needed_columns()) : "three"));
    return values;
  }
  std::size_t needed_columns() const {
    return *std::max_element(columns_.begin(), columns_.end()) + 1;
  }

  void add(BatchedVoxels& points, std::string_view line, std::uint64_t number) const {
    const std::array<double, kValues> values = values_of(line, number);
    const Vec3d point{values[0], values[1], values[2]};
    add_fields(points, line, number);
    if (!has_colors()) return points.add(point);
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = values[kCoordinates + c];
      if (!(value >= 0 && value <= color_range_))
        fail(number, "colour " + std::string(fields_of(line)[columns_[kCoordinates + c]]) +
                         " is not from 0 to " + std::to_string(static_cast<int>(color_range_)) +
                         ", as those of the first points are");
      color[c] = color_byte(value / color_range_);
    }
    points.add(point, color);
  }

  std::string name_;
  MappedFile file_;
  std::uint64_t header_line_ = 0;  ///< The line with the names of the columns; 0: none.
  bool has_names_ = false;
  std::vector<std::size_t> columns_{0, 1, 2};  ///< Of the coordinates, and perhaps of the colour.
  double color_range_ = 255;                   ///< The greatest component.
  std::vector<std::string> names_;             ///< Of all columns, if they have names.
  std::optional<std::size_t> label_column_;
  std::vector<std::size_t> channel_columns_;
  std::vector<ChannelSpec> channels_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_xyz_points(const std::filesystem::path& path,
                                             const LabelRequest& labels,
                                             const std::vector<ChannelRequest>& channels) {
  return std::make_unique<XyzPoints>(path, labels, channels);
}

}  // namespace voxdag
