#include "voxdag/formats/imports/volumes/nrrd_header.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "voxdag/core/error.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/printable.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kMaxNrrdHeaderBytes = std::size_t{1} << 20;

constexpr std::pair<std::string_view, ValueType> kNrrdTypes[] = {
    {"signed char", ValueType::kInt8},
    {"int8", ValueType::kInt8},
    {"int8_t", ValueType::kInt8},
    {"uchar", ValueType::kUint8},
    {"unsigned char", ValueType::kUint8},
    {"uint8", ValueType::kUint8},
    {"uint8_t", ValueType::kUint8},
    {"short", ValueType::kInt16},
    {"short int", ValueType::kInt16},
    {"signed short", ValueType::kInt16},
    {"signed short int", ValueType::kInt16},
    {"int16", ValueType::kInt16},
    {"int16_t", ValueType::kInt16},
    {"ushort", ValueType::kUint16},
    {"unsigned short", ValueType::kUint16},
    {"unsigned short int", ValueType::kUint16},
    {"uint16", ValueType::kUint16},
    {"uint16_t", ValueType::kUint16},
    {"int", ValueType::kInt32},
    {"signed int", ValueType::kInt32},
    {"int32", ValueType::kInt32},
    {"int32_t", ValueType::kInt32},
    {"uint", ValueType::kUint32},
    {"unsigned int", ValueType::kUint32},
    {"uint32", ValueType::kUint32},
    {"uint32_t", ValueType::kUint32},
    {"longlong", ValueType::kInt64},
    {"long long", ValueType::kInt64},
    {"long long int", ValueType::kInt64},
    {"signed long long", ValueType::kInt64},
    {"signed long long int", ValueType::kInt64},
    {"int64", ValueType::kInt64},
    {"int64_t", ValueType::kInt64},
    {"ulonglong", ValueType::kUint64},
    {"unsigned long long", ValueType::kUint64},
    {"unsigned long long int", ValueType::kUint64},
    {"uint64", ValueType::kUint64},
    {"uint64_t", ValueType::kUint64},
    {"float", ValueType::kFloat},
    {"double", ValueType::kDouble}};

constexpr std::pair<std::string_view, Encoding> kEncodings[] = {
    {"raw", Encoding::kRaw},     {"gzip", Encoding::kGzip},  {"gz", Encoding::kGzip},
    {"ascii", Encoding::kAscii}, {"text", Encoding::kAscii}, {"txt", Encoding::kAscii},
    {"hex", Encoding::kHex}};

bool is_nrrd_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_nrrd_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_nrrd_space(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    // "(1, 0, 0)" is one word.
    for (bool is_inside = false; end < text.size() && (is_inside || !is_nrrd_space(text[end]));
         ++end)
      is_inside = text[end] == '(' || (is_inside && text[end] != ')');
    if (end > at) words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

struct NrrdField {
  std::string value;
  std::uint64_t line;
};

class NrrdHeaderParser {
 public:
  NrrdHeaderParser(const std::filesystem::path& path, std::string_view text)
      : path_(path), text_(text) {}

  NrrdHeader parse() {
    read_fields();
    name_segments();
    parse_shape();
    parse_data();
    parse_spacing();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(std::uint64_t line, const std::string& reason) const {
    throw Error(path_.string(), ErrorPlace::line(line), reason);
  }

  void read_fields() {
    if (!text_.starts_with("NRRD")) fail(1, "does not begin with \"NRRD\"");
    std::uint64_t number = 0;
    for (std::size_t at = 0;;) {
      ++number;
      std::size_t end = text_.substr(0, kMaxNrrdHeaderBytes).find('\n', at);
      if (end == std::string_view::npos) {
        if (text_.size() > kMaxNrrdHeaderBytes) fail(number, "the header is longer than 1 MiB");
        end = text_.size();
      }
      const std::string_view line = trimmed(text_.substr(at, end - at));
      at = std::min(end + 1, text_.size());
      header_.end = at;
      if (line.empty()) return;
      if (number > 1 && line[0] != '#') read_field(line, number);
      if (at == text_.size()) break;
    }
    if (find("data file") == nullptr) fail(number, "the header has no empty line at its end");
  }

  void read_field(std::string_view line, std::uint64_t number) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) fail(number, "has no colon");
    if (line.substr(colon).starts_with(":=")) {
      pairs_.insert_or_assign(std::string(line.substr(0, colon)),
                              std::string(trimmed(line.substr(colon + 2))));
      return;
    }
    std::string name = lower_case(trimmed(line.substr(0, colon)));
    constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {
        {"datafile", "data file"}, {"lineskip", "line skip"}, {"byteskip", "byte skip"},
        {"axismins", "axis mins"}, {"axismaxs", "axis maxs"}, {"centerings", "centers"}};
    for (const auto& [other, usual] : kOtherNames)
      if (name == other) name = usual;
    const std::string value(trimmed(line.substr(colon + 1)));
    // Names of files would follow a LIST in place of fields.
    if (name == "data file" &&
        (value == "LIST" || value.starts_with("LIST ") || value.find('%') != value.npos))
      fail(number, "data in several files are not supported");
    const auto [field, is_new] = fields_.try_emplace(name, NrrdField{value, number});
    if (!is_new && field->second.value != value)
      fail(number, "the field " + name_in_quotes(name) + " is there twice, with other values");
  }

  /// Reads the names that 3D Slicer gives to labels: Segment0_LabelValue and Segment0_Name.
  void name_segments() {
    constexpr std::string_view kValue = "_LabelValue";
    for (const auto& [key, value] : pairs_) {
      if (!key.starts_with("Segment") || !key.ends_with(kValue)) continue;
      const auto name = pairs_.find(key.substr(0, key.size() - kValue.size()) + "_Name");
      const auto label = number_in<Label>(value);
      if (label && name != pairs_.end()) header_.label_names.emplace(*label, name->second);
    }
  }

  const NrrdField* find(const std::string& name) const {
    const auto field = fields_.find(name);
    return field == fields_.end() ? nullptr : &field->second;
  }
  const NrrdField& get(const std::string& name) const {
    const NrrdField* field = find(name);
    if (field == nullptr) throw Error(path_.string(), "header", "has no field '" + name + "'");
    return *field;
  }

  template <class T>
  std::optional<T> number_in(std::string_view word) const {
    T value{};
    const char* const end = word.data() + word.size();
    const auto [next, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || next != end) return std::nullopt;
    return value;
  }
  template <class T>
  T number_in(const NrrdField& field, std::string_view word) const {
    const std::optional<T> value = number_in<T>(trimmed(word));
    if (!value) fail(field.line, in_quotes(word) + " is not a number that is allowed here");
    return *value;
  }

  /// Returns the value of a table for a field.
  template <class Table>
  auto named_value(const std::string& name, const Table& table) const {
    const NrrdField& field = get(name);
    for (const auto& [key, value] : table)
      if (lower_case(field.value) == key) return value;
    fail(field.line, "the " + name + " " + in_quotes(field.value) + " is not supported");
  }

  /// Returns one word for each axis.
  std::vector<std::string_view> words_of_axes(const NrrdField& field) const {
    std::vector<std::string_view> words = words_of(field.value);
    if (words.size() != axes_)
      fail(field.line, "has " + std::to_string(words.size()) + " values for " +
                           std::to_string(axes_) + " axes");
    return words;
  }

  void parse_shape() {
    DenseVolume& volume = header_.volume;
    volume.type = named_value("type", kNrrdTypes);
    const NrrdField& dimension = get("dimension");
    axes_ = number_in<std::uint64_t>(dimension, dimension.value);
    const char* const kAllowed =
        "the volume must have 3 axes, or 4 if the first one has 3 or 4 channels of uint8, if the "
        "first or last one has one value, or if its kind is list";
    if (axes_ != 3 && axes_ != 4) fail(dimension.line, kAllowed);
    const NrrdField& sizes = get("sizes");
    std::vector<std::uint64_t> numbers;
    for (const std::string_view word : words_of_axes(sizes))
      numbers.push_back(number_in<std::uint64_t>(sizes, word));
    std::vector<std::string> kinds;
    if (const NrrdField* field = find("kinds"))
      for (const std::string_view word : words_of_axes(*field)) kinds.push_back(lower_case(word));
    is_list_last_ = axes_ == 4 && !kinds.empty() && kinds[3] == "list";
    if (axes_ == 4 && (is_list_last_ || (!kinds.empty() && kinds[0] == "list"))) {
      const std::uint64_t layers = numbers[is_list_last_ ? 3 : 0];
      if (layers < 1 || layers > DenseVolume::kMaxLayers)
        fail(sizes.line,
             "the list must have 1 to " + std::to_string(DenseVolume::kMaxLayers) + " layers");
      (is_list_last_ ? volume.repeats : volume.channels) = static_cast<int>(layers);
      volume.is_list = true;
    } else if (axes_ == 4) {
      const bool has_colors =
          (numbers[0] == 3 || numbers[0] == 4) && volume.type == ValueType::kUint8;
      // One channel, or one volume of a series.
      is_list_last_ = !has_colors && numbers[0] != 1 && numbers[3] == 1;
      if (!has_colors && numbers[0] != 1 && !is_list_last_) fail(sizes.line, kAllowed);
      if (has_colors) volume.channels = static_cast<int>(numbers[0]);
    }
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(first_axis()), 3,
                volume.size.begin());
    check_volume_size(path_, volume.size);
  }

  void parse_data() {
    header_.encoding = named_value("encoding", kEncodings);
    if (bytes_of(header_.volume.type) > 1 && header_.encoding != Encoding::kAscii)
      header_.volume.is_big_endian =
          named_value("endian", std::array{std::pair<std::string_view, bool>{"little", false},
                                           std::pair<std::string_view, bool>{"big", true}});
    else if (header_.encoding == Encoding::kAscii)
      header_.volume.is_big_endian = std::endian::native == std::endian::big;
    if (const NrrdField* skip = find("line skip"))
      header_.line_skip = number_in<std::uint64_t>(*skip, skip->value);
    if (const NrrdField* skip = find("byte skip")) {
      header_.byte_skip = number_in<std::int64_t>(*skip, skip->value);
      if (header_.byte_skip < (header_.encoding == Encoding::kRaw ? -1 : 0))
        fail(skip->line, "the byte skip must be 0 or greater, or -1 for raw data");
    }
    if (const NrrdField* file = find("data file")) {
      std::string name = file->value;
      // Teem writes "./name" for a file beside the header.
      if (name.starts_with("./")) name.erase(0, 2);
      if (name.empty() || name.find('\0') != std::string::npos)
        fail(file->line, name_in_quotes(name) + " is not the name of a data file");
      header_.data_file = name;
    }
  }

  void parse_spacing() {
    VolumePlacement& placement = header_.placement;
    if (const NrrdField* spacings = find("spacings")) {
      const auto words = words_of_axes(*spacings);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto value = number_in<double>(*spacings, words[first_axis() + axis]);
        // NaN: not known.
        if (std::isnan(value)) continue;
        if (!(value > 0))
          fail(spacings->line, "the spacing of the voxels must be between 1e-30 and 1e30, not " +
                                   std::string(words[first_axis() + axis]));
        placement.steps[axis] = placement.steps[axis] * value;
        placement.is_known = true;
      }
    }
    if (const NrrdField* directions = find("space directions")) {
      const auto words = words_of_axes(*directions);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string_view word = words[first_axis() + axis];
        if (word == "none") continue;
        placement.steps[axis] = vector_in(*directions, word);
        placement.is_known = true;
      }
    }
    if (const NrrdField* origin = find("space origin")) {
      placement.first_centre = vector_in(*origin, origin->value);
      placement.is_known = true;
    } else if (const NrrdField* mins = find("axis mins");
               mins != nullptr && !find("space directions")) {
      parse_axis_mins(*mins);
    }
  }

  /// Reads where the axes begin: at the centre of the first voxel, or, as usual, at its border.
  /// "axis maxs" gives the spacing of the axes if nothing else does.
  void parse_axis_mins(const NrrdField& mins) {
    VolumePlacement& placement = header_.placement;
    const NrrdField *const maxs = find("axis maxs"), *const centers = find("centers");
    Vec3d first;
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      const auto word = [&](const NrrdField& field) {
        return words_of_axes(field)[first_axis() + i];
      };
      const bool is_node = centers != nullptr && lower_case(word(*centers)) == "node";
      double& step = placement.steps[i][axis];
      const auto min = number_in<double>(mins, word(mins));
      if (maxs != nullptr && find("spacings") == nullptr) {
        const auto voxels = static_cast<double>(header_.volume.size[i]) - (is_node ? 1 : 0);
        const double spacing = (number_in<double>(*maxs, word(*maxs)) - min) / voxels;
        if (spacing > 0 && std::isfinite(spacing)) step = spacing;
      }
      placement.is_known |= !std::isnan(min);
      first[axis] = (std::isnan(min) ? 0 : min) + (is_node && !std::isnan(min) ? 0 : step / 2);
    }
    if (placement.is_known) placement.first_centre = first;
  }

  /// Returns the number of the volume's x axis.
  std::size_t first_axis() const { return axes_ == 4 && !is_list_last_ ? 1 : 0; }

  /// Reads "(x,y,z)".
  Vec3d vector_in(const NrrdField& field, std::string_view word) const {
    Vec3d vector;
    if (word.size() >= 2 && word.front() == '(' && word.back() == ')') {
      word = word.substr(1, word.size() - 2);
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t end = axis < 2 ? word.find(',') : word.size();
        if (end == std::string_view::npos) fail(field.line, "a vector has less than 3 components");
        vector[axis] = number_in<double>(field, word.substr(0, end));
        word.remove_prefix(std::min(end + 1, word.size()));
      }
      return vector;
    }
    fail(field.line, in_quotes(word) + " is not a vector of the form (x,y,z)");
  }

  const std::filesystem::path& path_;
  std::string_view text_;
  std::map<std::string, NrrdField> fields_;
  std::map<std::string, std::string>
      pairs_;  ///< Keys and values, which mean what their writer says.
  NrrdHeader header_;
  std::uint64_t axes_ = 0;
  bool is_list_last_ = false;  ///< The last axis counts layers.
};

}  // namespace

NrrdHeader parse_nrrd_header(const std::filesystem::path& path, std::string_view text) {
  return NrrdHeaderParser(path, text).parse();
}

}  // namespace voxdag
