#pragma once
/// The numbers that an option accepts.
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>

namespace voxdag::cli {

class NumberRange {
 public:
  static NumberRange whole(std::int64_t least, std::int64_t most);  ///< Both ends included.
  static NumberRange from(double least, double most);               ///< Both ends included.
  static NumberRange half_open(double least, double end);           ///< Without `end`.
  /// Returns the range of numbers above zero, up to `most`.
  static NumberRange up_to(double most);
  /// Returns the range of numbers above zero that are finite also as a float.
  static NumberRange positive();

  /// Returns the range as text for the help: "1 to 4096".
  const std::string& text() const { return text_; }

  /// Parses `text`. Throws std::invalid_argument with the range if it is not a number in the range.
  template <class Number>
  Number parse(const std::string& text) const {
    if constexpr (std::is_integral_v<Number>)
      return static_cast<Number>(parse_whole(text));
    else
      return static_cast<Number>(parse_real(text));
  }

 private:
  std::int64_t parse_whole(const std::string& text) const;
  double parse_real(const std::string& text) const;
  [[noreturn]] void refuse(const std::string& text, const char* kind) const;

  std::int64_t least_ = 0, most_ = 0;
  std::function<bool(double)> contains_;
  std::string text_, condition_;
};

}  // namespace voxdag::cli
