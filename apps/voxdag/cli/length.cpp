#include "cli/length.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "cli/parse.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag::cli {
namespace {

/// Returns how many units `to` a unit `from` has. Throws std::invalid_argument for unknown ones.
double units_in(const std::string& from, const std::string& to) {
  TransformRequest request;
  request.unit = from + ":" + to;
  return InputTransform(request, {}).factor();
}

}  // namespace

Length parse_length(const std::string& text) {
  const std::size_t end = text.find_last_of("0123456789.") + 1;
  const Length length{parse_positive(text.substr(0, end)), text.substr(end)};
  if (!length.unit.empty()) units_in(length.unit, "m");
  return length;
}

double in_scene_unit(const Length& length, const std::string& scene_unit, const std::string& path) {
  if (length.unit.empty() || length.unit == scene_unit) return length.value;
  if (scene_unit.empty())
    throw Error(
        path, "",
        fmt::format("does not say which unit its coordinates have: give {:g} without {}, in "
                    "this unit, or build the file with --unit",
                    length.value, length.unit));
  return length.value * units_in(length.unit, scene_unit);
}

}  // namespace voxdag::cli
