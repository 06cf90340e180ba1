#pragma once
/// Tables of text: cells of lines, their numbers, and comments.
#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

/// The cells of a line. A line that has the separator is cut there only; its cells may be empty and
/// hold blanks. Others, and all if the separator is 0, are cut at blanks, tabs, commas and
/// semicolons; cells may be empty beside a comma or semicolon. Cells in quotes stay whole; quotes
/// around a whole line do not count.
class TextCells {
 public:
  TextCells(std::string_view line, char separator) : rest_(line), separator_(separator) {
    const std::string_view body = trim(line);
    if (body.size() > 1 && body[0] == '"' && body.find('"', 1) == body.size() - 1)
      rest_ = body.substr(1, body.size() - 2);
    if (separator == 0 || rest_.find(separator) == rest_.npos) separator_ = 0;
    has_more_ = separator_ != 0;
  }

  /// Sets `cell` to the next one. Returns false if there is none.
  bool next(std::string_view& cell) { return separator_ != 0 ? next_whole(cell) : next_any(cell); }

 private:
  static bool is_comma(char c) { return c == ',' || c == ';'; }

  bool next_whole(std::string_view& cell) {
    if (!has_more_) return false;
    skip_blanks();
    std::size_t end = rest_.find(separator_);
    const std::size_t close = end_of_quotes();
    if (close != rest_.npos) end = rest_.find(separator_, close + 1);
    has_more_ = end != rest_.npos;
    cell = trim(rest_.substr(0, end));
    if (close != rest_.npos && close + 1 == cell.size()) cell = trim(cell.substr(1, close - 1));
    rest_.remove_prefix(has_more_ ? end + 1 : rest_.size());
    return true;
  }

  bool next_any(std::string_view& cell) {
    skip_blanks();
    if (rest_.starts_with('"') && next_quoted(cell)) return true;
    if (rest_.empty() && !has_more_) return false;
    std::size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end]) && !is_comma(rest_[end])) ++end;
    take(cell, 0, end, end);
    return true;
  }

  /// Takes the cell in quotes that begins here. Returns false, behind the quotes, if it has no end.
  bool next_quoted(std::string_view& cell) {
    const std::size_t close = end_of_quotes();
    if (close != rest_.npos) {
      take(cell, 1, close - 1, close + 1);
      return true;
    }
    for (; rest_.starts_with('"'); skip_blanks()) rest_.remove_prefix(1);
    return false;
  }

  /// Takes a cell of `size` characters from `first` on, and a comma behind `end`.
  void take(std::string_view& cell, std::size_t first, std::size_t size, std::size_t end) {
    cell = rest_.substr(first, size);
    rest_.remove_prefix(end);
    skip_blanks();
    has_more_ = !rest_.empty() && is_comma(rest_[0]);
    if (has_more_) rest_.remove_prefix(1);
  }

  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_[0]) && rest_[0] != separator_) rest_.remove_prefix(1);
  }

  /// Returns the place of the quote that ends a cell in quotes here; npos if there is none. Two
  /// quotes inside stand for one. Behind a quote without an end, the line has no cells in quotes.
  std::size_t end_of_quotes() {
    if (!has_quotes_ || !rest_.starts_with('"')) return rest_.npos;
    std::size_t close = rest_.find('"', 1);
    while (close != rest_.npos && rest_.substr(close + 1).starts_with('"'))
      close = rest_.find('"', close + 2);
    has_quotes_ = close != rest_.npos;
    return close;
  }

  std::string_view rest_;
  char separator_;  ///< 0: cut everywhere.
  bool has_quotes_ = true;
  bool has_more_ = false;  ///< A cell follows, even if the line ends here.
};

inline std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  std::string_view cell;
  for (TextCells rest(line, separator); rest.next(cell);) cells.push_back(cell);
  return cells;
}

/// Returns the semicolon, tab, comma or bar that cuts the line into at least three cells for which
/// accepts(cells) holds; 0 if none does.
template <class Accepts>
char find_separator(std::string_view line, const Accepts& accepts) {
  for (const char separator : {';', '\t', ',', '|'}) {
    if (line.find(separator) == line.npos) continue;
    const std::vector<std::string_view> cells = cells_of(line, separator);
    if (cells.size() >= 3 && accepts(cells)) return separator;
  }
  return 0;
}

inline bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns whether Windows wrote a number that is not finite: "1.#QNAN", "-1.#IND", "1.#INF00".
inline bool is_windows_nan(std::string_view field) {
  const std::size_t sign = field.rfind('#');
  return sign != field.npos && sign > 1 && field[sign - 1] == '.' && field[sign - 2] == '1';
}

/// Returns whether programs write this for a number that is missing.
inline bool is_missing(std::string_view field) {
  const std::string lower = lower_case(field);
  return lower == "na" || lower == "n/a" || lower == "null" || lower == "none";
}

/// Parses a number. Numbers of is_windows_nan() and missing ones are NaN.
inline bool parse_cell(std::string_view field, double& value) {
  if (parse_float(field, value)) return true;
  value = std::numeric_limits<double>::quiet_NaN();
  return is_windows_nan(field) || is_missing(field);
}

/// Returns the number of characters before the names in a line that is a comment or tells the
/// separator ("sep=;" of Excel); 0 if it is neither.
inline std::size_t comment_mark(std::string_view line) {
  const std::string_view body = trim(line);
  const auto blanks = static_cast<std::size_t>(body.data() - line.data());
  if (body.empty() || is_decimal_digit(body[0])) return 0;
  if (body.starts_with("sep=") || body.starts_with("\"sep=")) return line.size();
  if (!body.starts_with('#') && !body.starts_with("//") && !body.starts_with('%')) return 0;
  return blanks + std::min(body.find_first_not_of("#/%"), body.size());
}

/// Removes a comment from a line: it begins with # or //, outside of quotes, or % at the start.
inline std::string_view without_comment(std::string_view line) {
  if (comment_mark(line) > 0) return {};
  if (line.find('#') == line.npos && line.find("//") == line.npos) return line;
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') is_quoted = !is_quoted;
    const bool is_mark =
        line[i] == '#' ? !is_windows_nan(line.substr(0, i + 1)) : line.substr(i).starts_with("//");
    if (is_mark && !is_quoted) return line.substr(0, i);
  }
  return line;
}

inline bool is_byte_text(std::string_view field) {
  double value = 0;
  return std::all_of(field.begin(), field.end(), is_decimal_digit) && parse_float(field, value) &&
         value <= 255;
}

/// Returns whether a text has a comma between two digits.
inline bool has_inner_comma(std::string_view text) {
  for (std::size_t at = text.find(','); at != text.npos; at = text.find(',', at + 1))
    if (at > 0 && at + 1 < text.size() && is_decimal_digit(text[at - 1]) &&
        is_decimal_digit(text[at + 1]))
      return true;
  return false;
}

}  // namespace voxdag
