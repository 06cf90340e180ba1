#include "voxdag/formats/imports/points/pcd_header.hpp"

#include <algorithm>
#include <optional>

#include "voxdag/core/error.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {
namespace {

/// Far more than real files have.
constexpr std::size_t kMaxPcdHeaderBytes = std::size_t{1} << 20, kMaxFields = 1000;
constexpr std::int64_t kMaxValues = 1'000'000'000;  ///< Per field.

class PcdHeaderParser {
 public:
  PcdHeaderParser(std::string_view bytes, const std::string& name)
      : bytes_(bytes), rest_(bytes.substr(0, kMaxPcdHeaderBytes)), name_(name) {}

  PcdHeader parse() {
    if (bytes_.empty()) throw Error(name_, "", "the file is empty");
    for (bool is_last = false; !is_last;) {
      if (rest_.empty())
        fail(bytes_.size() > kMaxPcdHeaderBytes ? "the header has no line DATA in its first MiB"
                                                : "the file ends before the line DATA");
      ++line_;
      std::string_view text = next_line(rest_, '\n');
      const std::string_view keyword = next_token(text);
      if (keyword.empty() || keyword[0] == '#' || keyword == "VIEWPOINT") continue;
      is_last = keyword == "DATA";
      parse_line(keyword, text);
    }
    header_.body = static_cast<std::size_t>(rest_.data() - bytes_.data());
    if (header_.fields.empty()) fail("the header has no line FIELDS");
    count_points();
    place_fields();
    check_size();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(name_, ErrorPlace::line(line_), reason);
  }

  void parse_line(std::string_view keyword, std::string_view text) {
    if (keyword == "VERSION")
      check_version(next_token(text));
    else if (keyword == "FIELDS" || keyword == "COLUMNS")
      parse_fields(text);
    else if (keyword == "SIZE")
      for_each_field(text, keyword, [&](PcdField& field, std::string_view token) {
        field.size = static_cast<std::uint64_t>(parse_count(token, keyword, 1, 8));
      });
    else if (keyword == "TYPE")
      for_each_field(text, keyword, [&](PcdField& field, std::string_view token) {
        if (token != "F" && token != "I" && token != "U")
          fail("type " + in_quotes(token) + " is not F, I or U");
        field.type = token[0];
      });
    else if (keyword == "COUNT")
      for_each_field(text, keyword, [&](PcdField& field, std::string_view token) {
        // Drivers of scanners write padding as fields without values.
        field.count = static_cast<std::uint64_t>(parse_count(token, keyword, 0, kMaxValues));
      });
    else if (keyword == "WIDTH")
      width_ = parse_number(next_token(text), keyword);
    else if (keyword == "HEIGHT")
      height_ = parse_number(next_token(text), keyword);
    else if (keyword == "POINTS")
      points_ = parse_number(next_token(text), keyword);
    else if (keyword == "DATA")
      parse_data(next_token(text));
    else
      fail(line_ == 1 ? "not a PCD file: it does not start with a PCD header"
                      : "unknown PCD header keyword " + in_quotes(keyword));
  }

  void check_version(std::string_view version) const {
    std::string_view minor = version;
    if (minor.starts_with('0')) minor.remove_prefix(1);
    if (minor != ".5" && minor != ".6" && minor != ".7")
      fail("PCD version " + in_quotes(version) + " is not 0.5, 0.6 or 0.7");
  }

  void parse_fields(std::string_view text) {
    if (!header_.fields.empty()) fail("the header has two lines FIELDS");
    for (;;) {
      const std::string_view token = next_token(text);
      if (token.empty()) return;
      if (header_.fields.size() >= kMaxFields)
        fail("more than " + std::to_string(kMaxFields) + " fields");
      header_.fields.push_back({token});
    }
  }

  template <class OnField>
  void for_each_field(std::string_view text, std::string_view keyword, const OnField& on_field) {
    for (PcdField& field : header_.fields) {
      const std::string_view token = next_token(text);
      if (token.empty())
        fail(std::string(keyword) + " has no value for field " + in_quotes(field.name));
      on_field(field, token);
    }
    if (!next_token(text).empty()) fail(std::string(keyword) + " has more values than FIELDS");
  }

  std::uint64_t parse_number(std::string_view token, std::string_view keyword) const {
    std::int64_t number = 0;
    if (!parse_int(token, number) || number < 0)
      fail(std::string(keyword) + " " + in_quotes(token) + " is not a whole number of 0 or more");
    return static_cast<std::uint64_t>(number);
  }

  std::int64_t parse_count(std::string_view token, std::string_view keyword, std::int64_t least,
                           std::int64_t most) const {
    std::int64_t number = 0;
    if (!parse_int(token, number) || number < least || number > most)
      fail(std::string(keyword) + " " + in_quotes(token) + " is not a whole number from " +
           std::to_string(least) + " to " + std::to_string(most));
    return number;
  }

  void parse_data(std::string_view token) {
    const std::string data = lower_case(token);
    if (data == "ascii")
      header_.data = PcdData::kAscii;
    else if (data == "binary")
      header_.data = PcdData::kBinary;
    else if (data == "binary_compressed")
      header_.data = PcdData::kCompressed;
    else
      fail("DATA " + in_quotes(token) + " is not ascii, binary or binary_compressed");
  }

  void count_points() {
    if (!width_ && !points_) fail("the header has neither WIDTH nor POINTS");
    if (width_) {
      const std::uint64_t height = height_.value_or(1);
      const bool fits = height == 0 || *width_ <= UINT64_MAX / height;
      const std::uint64_t product = fits ? *width_ * height : UINT64_MAX;
      if (points_.value_or(product) != product || !fits) fail("POINTS is not WIDTH times HEIGHT");
      points_ = product;
    }
    header_.points = *points_;
  }

  void place_fields() {
    for (PcdField& field : header_.fields) {
      const bool is_float = field.type == 'F';
      if (!(field.size == 4 || field.size == 8 || (!is_float && field.size <= 2)))
        fail("field " + in_quotes(field.name) + " has type " + field.type + " with " +
             std::to_string(field.size) + " bytes");
      field.offset = header_.point_bytes;
      field.ordinal = header_.point_values;
      header_.point_bytes += field.size * field.count;
      header_.point_values += field.count;
    }
    if (header_.point_values == 0) fail("the points have no values");
  }

  /// Refuses a count that is too large for the rest of the file.
  void check_size() const {
    const std::uint64_t rest = bytes_.size() - header_.body;
    std::uint64_t room = UINT64_MAX;
    if (header_.data == PcdData::kBinary) room = rest / header_.point_bytes;
    // A value of text has a digit and a separator. The last separator may be missing.
    if (header_.data == PcdData::kAscii) room = (rest + 1) / (2 * header_.point_values);
    if (header_.points > room)
      fail("the file is too short for " + std::to_string(header_.points) + " points");
  }

  std::string_view bytes_, rest_;
  const std::string& name_;
  std::uint64_t line_ = 0;
  std::optional<std::uint64_t> width_, height_, points_;
  PcdHeader header_;
};

}  // namespace

int PcdHeader::find(std::string_view name) const {
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].name == name) return static_cast<int>(i);
  return -1;
}

PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name) {
  return PcdHeaderParser(bytes, name).parse();
}

}  // namespace voxdag
