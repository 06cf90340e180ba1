#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/column_names.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/points/text_cells.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;
/// Points that decide whether the columns behind the coordinates are colours.
constexpr std::size_t kSampledPoints = 4096;

class XyzPoints : public VoxelSource {
 public:
  XyzPoints(const std::filesystem::path& path, PointText kind, const LabelRequest& labels,
            const std::vector<ChannelRequest>& channels)
      : name_(path.string()), kind_(kind), file_(path, MappedFile::Access::kSequential) {
    if (file_.text().starts_with("\xFF\xFE") || file_.text().starts_with("\xFE\xFF"))
      throw Error(name_, "", "is a text in UTF-16: save it in UTF-8");
    text_ = without_byte_order_mark(file_.text());
    constexpr std::string_view kFiller("\0\x1A", 2);
    if (const std::size_t end = text_.find_last_not_of(kFiller) + 1; end < text_.size()) {
      warnings_.push_back("bytes after the text, 0 or Ctrl-Z, are left out: " +
                          std::to_string(text_.size() - end));
      text_ = text_.substr(0, end);
    }
    find_header();
    if (labels) label_column_ = column_of(*labels);
    for (const ChannelRequest& channel : channels) {
      if (channel.field.empty()) throw Error("", "", "a channel needs the name of a field");
      channel_columns_.push_back(column_of(channel.field));
      channels_.push_back(channel_spec(channel, ChannelKind::kF32));
    }
    check_first_points();
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

  [[noreturn]] void fail_at_commas(std::uint64_t line) const {
    fail(line, "has commas inside numbers and other separators between them: write decimal points");
  }

  /// Calls use(line, number) for the lines with fields, without comments, until it returns false.
  /// Leaves out the header.
  template <class Use>
  void for_each_line(const Use& use) const {
    std::string_view text = text_;
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
    std::string_view text = text_;
    const char line_end = line_end_of(text);
    std::string_view names;
    for (std::uint64_t number = 1; !text.empty(); ++number) {
      std::string_view line = next_line(text, line_end).substr(0, kMaxLineBytes);
      const std::size_t mark = comment_mark(line);
      if (mark > 0) {
        line = trim(line.substr(mark));
        if (has_coordinate_names(names_of(line))) names = line;
        continue;
      }
      line = without_comment(line);
      const std::vector<std::string_view> cells = names_of(line), any = cells_of(line, 0);
      if (cells.empty() || any.empty() || count_of(line)) continue;
      const bool are_names = header_line_ == 0 && has_coordinate_names(cells);
      if (!names.empty() && !are_names) break;
      if (!are_names) {
        double ignored = 0;
        const bool has_numbers =
            std::any_of(cells.begin(), cells.end(),
                        [&](std::string_view cell) { return parse_cell(cell, ignored); });
        if (cells[0].empty() ? has_numbers
                             : parse_cell(cells[0], ignored) || parse_cell(any[0], ignored) ||
                                   has_inner_comma(any[0]))
          break;
        if (cells.size() < kCoordinates || has_numbers)
          fail(number, "number 1, " + in_quotes(cells[0]) + ", is not a number");
      }
      header_line_ = number;
      names = line;
    }
    separator_ = separator_of_names(names);
    const std::vector<std::string_view> cells = names_of(names);
    names_.assign(cells.begin(), cells.end());
    use_names(cells);
  }

  /// Checks the first points, so that no warnings go before their errors. Finds the separator if
  /// the names do not tell it.
  void check_first_points() {
    std::size_t points = 0;
    for_each_line([&](std::string_view line, std::uint64_t number) {
      if (count_of(line)) return true;
      if (points == 0) check_columns(line, number);
      values_of(line, number);
      return ++points < kSampledPoints;
    });
  }

  /// Checks the first line of points. Finds the separator if the names do not tell it.
  void check_columns(std::string_view line, std::uint64_t number) {
    const bool has_mixed_names = separator_ == 0;
    if (line.find(separator_) == line.npos)
      separator_ = find_separator(
          line, [&](const auto& cells) { return may_be_point(cells, line.find('\t')); });
    const std::size_t count = cells_of(line, separator_).size();
    // Names with blanks have shifted the columns behind them.
    std::vector<std::size_t> used = columns_;
    used.insert(used.end(), channel_columns_.begin(), channel_columns_.end());
    if (label_column_) used.push_back(*label_column_);
    if (has_mixed_names && count < names_.size() &&
        *std::max_element(used.begin(), used.end()) >= used.size())
      fail(number, "has " + std::to_string(count) + " numbers, but " +
                       std::to_string(names_.size()) + " columns have names");
  }

  /// Returns whether the coordinates are numbers, or some are empty cells. Tabs may align columns,
  /// so that an empty cell between them is none.
  bool may_be_point(const std::vector<std::string_view>& cells, std::size_t tab) const {
    bool has_number = false;
    for (std::size_t c = 0; c < kCoordinates; ++c) {
      if (columns_[c] >= cells.size()) return false;
      double ignored = 0;
      const std::string_view cell = cells[columns_[c]];
      if (parse_cell(cell, ignored))
        has_number = true;
      else if (!cell.empty() || tab != std::string_view::npos)
        return false;
    }
    return has_number;
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
    const std::vector<std::string_view> fields = cells_of(line, separator_);
    const auto value_in = [&](std::size_t column, const char* what) {
      double value = 0;
      if (column >= fields.size() || !parse_cell(fields[column], value))
        fail(number, std::string("has no ") + what + " in column " + std::to_string(column + 1));
      return value;
    };
    if (label_column_) points.add_label(label_of(value_in(*label_column_, "label")));
    for (const std::size_t column : channel_columns_)
      points.add_channel(value_in(column, "number"));
  }

  void use_names(const std::vector<std::string_view>& names) {
    if (names.empty()) return;
    std::array<std::optional<std::size_t>, kPointValues + 1> columns;
    for (std::size_t column = names.size(); column-- > 0;)
      columns[value_of_name(names[column])] = column;
    const bool has_places = columns[0] && columns[1] && columns[2],
               has_colors = columns[3] && columns[4] && columns[5];
    for (std::size_t value = 0; has_places && value < kCoordinates; ++value)
      columns_[value] = *columns[value];
    for (std::size_t value = kCoordinates; has_colors && value < kPointValues; ++value)
      columns_.push_back(*columns[value]);
    has_names_ = has_places || has_colors;
    if (!has_places)
      warnings_.push_back("its columns " + in_quotes(names[0]) + ", " + in_quotes(names[1]) +
                          " and " + in_quotes(names[2]) + " are taken for x, y and z");
    const auto color = std::find_if(names.begin(), names.end(), is_color_name);
    if (has_names_ && !has_colors && color != names.end())
      warnings_.push_back("its column " + in_quotes(*color) +
                          " is left out: colours are three columns, red, green and blue");
  }

  /// Finds colours without names: three columns of whole numbers to 255 behind the coordinates, or
  /// behind a normal, or behind a column more. The endings .pts and .xyzrgb tell where.
  void find_colors() {
    std::size_t points = 0, fewest = SIZE_MAX;
    constexpr std::size_t kColumns = 9;
    std::array<bool, kColumns> is_byte;
    is_byte.fill(true);
    std::array<double, kColumns> greatest{}, least;
    least.fill(255);
    for_each_line([&](std::string_view line, std::uint64_t) {
      if (count_of(line)) return true;
      const std::vector<std::string_view> fields = cells_of(line, separator_);
      fewest = std::min(fewest, fields.size());
      for (std::size_t i = kCoordinates; i < std::min(kColumns, fields.size()); ++i) {
        double value = 0;
        is_byte[i] &= is_byte_text(fields[i]) && parse_float(fields[i], value);
        greatest[i] = std::max(greatest[i], value);
        least[i] = std::min(least[i], value);
      }
      return ++points < kSampledPoints;
    });
    if (points == 0 || fewest <= kCoordinates) return;
    for (std::size_t i = 0; i < kColumns; ++i)
      is_byte[i] &=
          label_column_ != i &&
          std::find(channel_columns_.begin(), channel_columns_.end(), i) == channel_columns_.end();
    const auto are_bytes = [&](std::size_t first) {
      return fewest >= first + 3 && is_byte[first] && is_byte[first + 1] && is_byte[first + 2];
    };
    if (kind_ == PointText::kXyzrgb && fewest >= kPointValues) return use_colors(3);
    // A colour and perhaps a normal follow the intensity of .pts files.
    const bool is_pts = kind_ == PointText::kPts && (fewest == 7 || fewest == 10) && are_bytes(4);
    // Normals along an axis are whole numbers, too.
    const auto are_colors = [&](std::size_t first) {
      return are_bytes(first) &&
             (is_pts || std::max({greatest[first], greatest[first + 1], greatest[first + 2]}) > 1);
    };
    for (const std::size_t first : {std::size_t{3}, std::size_t{6}, std::size_t{4}}) {
      if (!are_colors(first) || (is_pts && first != 4)) continue;
      if (const std::uint64_t line = line_without_color(first)) {
        warnings_.push_back(numbers_of_columns(first) +
                            " are left out: they have no names, and line " + std::to_string(line) +
                            " has no colour there");
        return;
      }
      // Column 7 is no opacity and no normal.
      if (first == 3 && are_colors(4) && greatest[6] > 1 && least[6] < 255)
        warnings_.push_back(numbers_of_columns(3) +
                            " are taken for the colour, which columns 5 to 7 could be, "
                            "too: they have no names");
      return use_colors(first);
    }
    if (fewest >= kPointValues && !label_column_ && channels_.empty())
      warnings_.emplace_back(
          "its columns after the third are left out: they have no names, and are no colours of "
          "whole numbers from 0 to 255");
  }

  static std::string numbers_of_columns(std::size_t first) {
    return "its columns " + std::to_string(first + 1) + " to " + std::to_string(first + 3);
  }
  void use_colors(std::size_t first) {
    for (std::size_t c = 0; c < 3; ++c) columns_.push_back(first + c);
  }

  /// Returns the first line whose columns [first, first + 3) are no whole numbers from 0 to 255;
  /// 0 if there is none.
  std::uint64_t line_without_color(std::size_t first) const {
    PassedPages pages(file_, file_.text().data());
    std::uint64_t found = 0;
    for_each_line([&](std::string_view line, std::uint64_t number) {
      if (count_of(line)) return true;
      TextCells fields(line, separator_);
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
      const std::array<double, kPointValues> values = values_of(line, number);
      const std::vector<std::string_view> fields = cells_of(line, separator_);
      for (std::size_t c = kCoordinates; c < kPointValues; ++c) {
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

  std::array<double, kPointValues> values_of(std::string_view line, std::uint64_t number) const {
    const bool is_cut_once = separator_ != 0 && line.find(separator_) != line.npos;
    if (!is_cut_once && line.find(',') != line.npos && line.find_first_of(" \t;\"") != line.npos &&
        has_inner_comma(trim(line)))
      fail_at_commas(number);
    std::array<double, kPointValues> values{};
    std::size_t found = 0, column = 0;
    TextCells fields(line, separator_);
    for (std::string_view field; found < columns_.size() && fields.next(field); ++column) {
      for (std::size_t value = 0; value < columns_.size(); ++value) {
        if (columns_[value] != column) continue;
        if (parse_cell(field, values[value]) || (value < kCoordinates && field.empty())) {
          ++found;
          continue;
        }
        if (has_inner_comma(field)) fail_at_commas(number);
        fail(number, "number " + std::to_string(column + 1) + ", " + in_quotes(field) +
                         ", is not a number");
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
    const std::array<double, kPointValues> values = values_of(line, number);
    const Vec3d point{values[0], values[1], values[2]};
    add_fields(points, line, number);
    if (!has_colors()) return points.add(point);
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = values[kCoordinates + c];
      if (!(value >= 0 && value <= color_range_))
        fail(number, "colour " +
                         std::string(cells_of(line, separator_)[columns_[kCoordinates + c]]) +
                         " is not from 0 to " + std::to_string(static_cast<int>(color_range_)) +
                         ", as those of the first points are");
      color[c] = color_byte(value / color_range_);
    }
    points.add(point, color);
  }

  std::string name_;
  PointText kind_;
  MappedFile file_;
  std::string_view text_;  ///< Without a byte order mark, and bytes that fill it up at its end.
  char separator_ = 0;     ///< Cuts lines into cells; 0: see TextCells.
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
                                             const std::vector<ChannelRequest>& channels,
                                             PointText kind) {
  return std::make_unique<XyzPoints>(path, kind, labels, channels);
}

}  // namespace voxdag
