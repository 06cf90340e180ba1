#include "cli/number_range.hpp"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "cli/parse.hpp"

namespace voxdag::cli {

NumberRange NumberRange::whole(std::int64_t least, std::int64_t most) {
  NumberRange range;
  range.least_ = least;
  range.most_ = most;
  range.text_ = fmt::format("{} to {}", least, most);
  range.condition_ = "from " + range.text_;
  return range;
}

NumberRange NumberRange::from(double least, double most) {
  NumberRange range;
  range.contains_ = [=](double n) { return n >= least && n <= most; };
  range.text_ = fmt::format("{} to {}", least, most);
  range.condition_ = "from " + range.text_;
  return range;
}

NumberRange NumberRange::half_open(double least, double end) {
  NumberRange range;
  range.contains_ = [=](double n) { return n >= least && n < end; };
  range.text_ = fmt::format("{} to less than {}", least, end);
  range.condition_ = "from " + range.text_;
  return range;
}

NumberRange NumberRange::up_to(double most) {
  NumberRange range;
  range.contains_ = [=](double n) { return n > 0 && n <= most; };
  range.condition_ = range.text_ = fmt::format("above 0, at most {}", most);
  return range;
}

NumberRange NumberRange::positive() {
  NumberRange range;
  range.contains_ = [](double n) {
    const auto as_float = static_cast<float>(n);
    return as_float > 0 && std::isfinite(as_float);
  };
  range.text_ = "above 0";
  range.condition_ = "above 0 and finite";
  return range;
}

std::int64_t NumberRange::parse_whole(const std::string& text) const {
  const std::optional<std::int64_t> number = read_whole_number(text);
  if (!number || *number < least_ || *number > most_) refuse(text, "a whole number");
  return *number;
}

double NumberRange::parse_real(const std::string& text) const {
  const std::optional<double> number = read_number(text);
  if (!number || !contains_(*number)) refuse(text, "a number");
  return *number;
}

void NumberRange::refuse(const std::string& text, const char* kind) const {
  throw std::invalid_argument(fmt::format("\"{}\" is not {} {}", text, kind, condition_));
}

}  // namespace voxdag::cli
