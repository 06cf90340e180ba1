// Parses the header of a .npy file, a Python dictionary of three literals.
#include <charconv>

#include "voxdag/core/error.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag {
namespace {

class Parser {
 public:
  Parser(std::string_view text, std::uint64_t first_byte) : text_(text), first_byte_(first_byte) {}

  NpyHeader parse() {
    NpyHeader header;
    bool has_dtype = false, has_order = false, has_shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string key = quoted();
      expect(':');
      if (key == "descr" && !has_dtype) {
        header.dtype = peek() == '[' ? list() : quoted();
        has_dtype = true;
      } else if (key == "fortran_order" && !has_order) {
        header.fortran_order = boolean();
        has_order = true;
      } else if (key == "shape" && !has_shape) {
        header.shape = tuple();
        has_shape = true;
      } else {
        fail("unexpected key in the header");
      }
      if (!accept(',') && peek() != '}') fail("malformed header: expected ',' or '}'");
    }
    if (peek() != '\0') fail("text after the header's dictionary");
    if (!has_dtype || !has_order || !has_shape)
      fail("the header must have 'descr', 'fortran_order' and 'shape'");
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error("", ErrorPlace::byte(first_byte_ + at_), reason);
  }

  /// Returns the next character that is not a space; 0 at the end.
  char peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(std::string("malformed header: expected '") + c + "'");
  }

  std::string quoted() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') fail("malformed header: expected a string");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("malformed header: a string has no closing quote");
    std::string value(text_.substr(at_ + 1, end - at_ - 1));
    if (value.find('\\') != std::string::npos)
      fail("malformed header: strings must not contain '\\'");
    at_ = end + 1;
    return value;
  }

  /// Returns the text of a bracketed list. Ignores brackets inside strings.
  std::string list() {
    const std::size_t begin = at_;
    int depth = 0;
    do {
      const char c = peek();
      if (c == '\0') fail("malformed header: a list has no closing bracket");
      if (c == '\'' || c == '"') {
        quoted();
        continue;
      }
      if (c == '[' || c == '(') ++depth;
      if (c == ']' || c == ')') --depth;
      ++at_;
    } while (depth > 0);
    return std::string(text_.substr(begin, at_ - begin));
  }

  bool boolean() {
    peek();
    for (const auto& [word, value] :
         {std::pair{std::string_view("True"), true}, std::pair{std::string_view("False"), false}})
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return value;
      }
    fail("malformed header: expected True or False");
  }

  std::vector<std::uint64_t> tuple() {
    std::vector<std::uint64_t> values;
    expect('(');
    while (!accept(')')) {
      peek();
      std::uint64_t value = 0;
      const char* begin = text_.data() + at_;
      const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
      if (error != std::errc()) fail("malformed header: expected a size");
      at_ += static_cast<std::size_t>(end - begin);
      values.push_back(value);
      if (!accept(',') && peek() != ')') fail("malformed header: expected ',' or ')'");
    }
    return values;
  }

  std::string_view text_;
  std::uint64_t first_byte_;
  std::size_t at_ = 0;
};

}  // namespace

NpyHeader parse_npy_header(std::string_view text, std::uint64_t first_byte) {
  return Parser(text, first_byte).parse();
}

}  // namespace voxdag
