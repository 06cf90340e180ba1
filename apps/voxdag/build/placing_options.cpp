#include "build/placing_options.hpp"

#include <fmt/core.h>

#include <string_view>
#include <utility>

#include "cli/parse.hpp"

namespace voxdag::cli {
namespace {

/// Returns "[FROM:]UNIT" with the names of units shortened: "inches:metre" becomes "in:m".
std::string short_units(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kNames[] = {
      {"millimetre", "mm"}, {"centimetre", "cm"}, {"metre", "m"}, {"inch", "in"},
      {"inches", "in"},     {"foot", "ft"},       {"feet", "ft"}};
  if (const std::size_t colon = text.find(':'); colon != text.npos)
    return short_units(text.substr(0, colon)) + ":" + short_units(text.substr(colon + 1));
  const std::string_view singular =
      text.ends_with("metres") ? text.substr(0, text.size() - 1) : text;
  for (const auto& [name, shorter] : kNames)
    if (singular == name) return std::string(shorter);
  return std::string(text);
}

/// Returns a parser of the option that `member` stores: InputTransform checks the text.
template <class Member>
auto transform_text(Member TransformRequest::*member) {
  return [member](const std::string& text) {
    TransformRequest request;
    request.*member = text;
    InputTransform(request, {});
    return text;
  };
}

}  // namespace

void add_margin_options(const Command& command, GridRequest& grid) {
  command
      .flag("--snap", grid.snap,
            "With --voxel-size: start the grid at multiples of SIZE, so that the voxels of builds "
            "with one SIZE coincide and the builds combine")
      .only_if([&grid] { return grid.voxel_size.has_value(); }, "without --voxel-size")
      .only_if([&grid] { return !grid.origin; }, "with --origin");
  command
      .number("--padding", grid.padding, NumberRange::whole(0, (1 << kMaxLevels) / 2), "N",
              "Leave N empty voxels on each side of the content; -r counts them")
      .only_if([&grid] { return !grid.bounds && !grid.origin; }, "with --bounds or --origin");
  command
      .flag("--center", grid.center,
            "Put the content in the middle of the grid, to a whole voxel (default: at its lower "
            "corner)")
      .only_if([&grid] { return !grid.origin; }, "with --origin");
}

void add_transform_options(const Command& command, TransformRequest& transform) {
  command.parsed(
      "--up", transform.up, transform_text(&TransformRequest::up), "[FROM:]x|y|z",
      "Turn the input so that this axis points up. FROM: the axis that points up in the input "
      "(default: as a .dae or .fbx file says, z for .stl, .3mf, points and volumes, else y)");
  command.parsed(
      "--unit", transform.unit,
      [parse = transform_text(&TransformRequest::unit)](const std::string& text) {
        return parse(short_units(text));
      },
      "[FROM:]mm|cm|m|in|ft",
      "Unit of the result. FROM: unit of the input, which is converted (default: m for glTF "
      "and COLLADA, mm for 3MF, as a .fbx file says, else the unit of the result)");
  command.parsed("--scale", transform.scale, parse_positive, "FACTOR",
                 "Multiply the coordinates, after --unit and --up");
  command.parsed(
      "--rotate", transform.rotate, transform_text(&TransformRequest::rotate), "AXIS:DEGREES,...",
      "Turn about the origin, counter-clockwise seen from the tip of the axis: z:90,x:45");
  command.parsed("--translate", transform.translate, parse_vec3, "X,Y,Z",
                 "Move, after all turns, in the units of the result");
}

std::string transform_table(const TransformRequest& transform, const FormatCustom& custom) {
  std::map<std::string, std::string> settings;
  add_settings(transform, settings);
  if (settings.empty()) return "";
  std::string text;
  for (const auto& [name, value] : settings)
    if (!name.ends_with("_from"))
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, value);
  if (!transform.up.empty())
    text += settings.contains("up_from")
                ? fmt::format(" (the input: {})", settings["up_from"])
                : fmt::format(" (the input: {}, as its file or format has it)", "xyz"[custom.up]);
  return fmt::format("  {:<14}{}\n", "moved", text);
}

}  // namespace voxdag::cli
