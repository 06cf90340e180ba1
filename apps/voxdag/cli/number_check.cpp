#include "cli/number_check.hpp"

#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <string>

#include "cli/parse.hpp"

namespace voxdag {
namespace {

/// `kind` is "a number", `range` where they lie: "from 0 to 1", as the help has it, too.
template <class Number>
CLI::Validator check(std::optional<Number> (*read)(std::string_view),
                     std::function<bool(Number)> is_good, const std::string& kind,
                     const std::string& range) {
  const auto fault = [=](const std::string& text) {
    const std::optional<Number> number = read(text);
    if (number && is_good(*number)) return std::string();
    return fmt::format("\"{}\" is not {} {}", text, kind, range);
  };
  return CLI::Validator(fault, range);
}

}  // namespace

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  return check<std::int64_t>(
      read_whole_number, [=](std::int64_t n) { return n >= least && n <= most; }, "a whole number",
      fmt::format("from {} to {}", least, most));
}

CLI::Validator number_from(double least, double most) {
  return check<double>(
      read_number, [=](double n) { return n >= least && n <= most; }, "a number",
      fmt::format("from {} to {}", least, most));
}

CLI::Validator number_between(double low, double high) {
  return check<double>(
      read_number, [=](double n) { return n > low && n < high; }, "a number",
      fmt::format("between {} and {}", low, high));
}

CLI::Validator positive_number() {
  return check<double>(
      read_number,
      [](double n) {
        const auto as_float = static_cast<float>(n);
        return as_float > 0 && std::isfinite(as_float);
      },
      "a number", "greater than 0 and finite");
}

}  // namespace voxdag
