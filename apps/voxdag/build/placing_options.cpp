#include "build/placing_options.hpp"

#include <fmt/core.h>
#include <glob.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "cli/parse.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

/// Returns a parser of a text that InputTransform understands: it is stored by `member`.
template <class Member>
auto transform_text(Member TransformRequest::*member) {
  return [member](const std::string& text) {
    TransformRequest request;
    request.*member = text;
    InputTransform(request, {});
    return text;
  };
}

bool has_ending(std::string name, const std::vector<std::string>& endings) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& ending) { return name.ends_with(ending); });
}

std::vector<std::string> matches_of(const std::string& pattern) {
  glob_t found{};
  std::vector<std::string> files;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  return files;
}

}  // namespace

void add_margin_options(const Command& command, GridRequest& grid) {
  command
      .flag("--snap", grid.snap,
            "With --voxel-size: the grid starts at multiples of SIZE, so that builds with the same "
            "SIZE have their voxels at the same places and combine")
      .only_if([&grid] { return grid.voxel_size.has_value(); }, "without --voxel-size")
      .only_if([&grid] { return !grid.origin; }, "with --origin");
  command
      .number("--padding", grid.padding, NumberRange::whole(0, (1 << kMaxLevels) / 2), "N",
              "Empty voxels on each side of the content; -r counts them")
      .only_if([&grid] { return !grid.bounds && !grid.origin; }, "with --bounds or --origin");
  command
      .flag("--center", grid.center,
            "The content lies in the middle of the grid, to a whole voxel (default: at its lower "
            "corner)")
      .only_if([&grid] { return !grid.origin; }, "with --origin");
}

void add_transform_options(const Command& command, TransformRequest& transform) {
  command.parsed("--up", transform.up, transform_text(&TransformRequest::up), "[FROM:]x|y|z",
                 "Turn the input so that this axis points up. FROM: the one that does in the input "
                 "(default: as a .dae file says; z in .stl, .3mf, points and volumes; else y)");
  command.parsed("--unit", transform.unit, transform_text(&TransformRequest::unit),
                 "[FROM:]mm|cm|m|in|ft",
                 "Unit of the result's coordinates. FROM: that of the input, which is converted "
                 "(default: m for glTF; others are taken to be in the result's unit)");
  command.parsed("--scale", transform.scale, parse_positive, "FACTOR",
                 "Multiply the coordinates, after --unit and --up");
  command.parsed(
      "--rotate", transform.rotate, transform_text(&TransformRequest::rotate), "AXIS:DEGREES,...",
      "Turn about the origin, counter-clockwise seen from the tip of the axis: z:90,x:45");
  command.parsed("--translate", transform.translate, parse_vec3, "X,Y,Z",
                 "Move, after all turns, in the units of the result");
}

std::int64_t parse_resolution(const std::string& text) {
  constexpr std::int64_t kMax = std::int64_t{1} << kMaxLevels;
  const bool kilo = text.ends_with('K') || text.ends_with('k');
  const auto n = read_whole_number(std::string_view(text).substr(0, text.size() - (kilo ? 1 : 0)));
  if (!n || *n < 1 || *n > (kilo ? kMax / 1024 : kMax))
    throw std::invalid_argument(
        fmt::format("\"{}\" is not a whole number from 1 to {}", text, kMax));
  return kilo ? *n * 1024 : *n;
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

std::vector<std::string> expand_inputs(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& endings) {
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    std::error_code unknown;
    std::vector<std::string> found;
    if (fs::is_directory(argument, unknown)) {
      for (const fs::directory_entry& entry : fs::directory_iterator(argument, unknown))
        if (has_ending(entry.path().filename().string(), endings))
          found.push_back(entry.path().string());
      std::sort(found.begin(), found.end());
    } else if (argument.find_first_of("*?[") != argument.npos && !fs::exists(argument, unknown)) {
      found = matches_of(argument);
    }
    if (found.empty()) found = {argument};
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

std::string names_of(const std::vector<std::string>& files) {
  constexpr std::size_t kMost = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(files.size(), kMost); ++i)
    names += (i == 0 ? "" : ", ") + fs::path(files[i]).filename().string();
  return files.size() <= kMost ? names : fmt::format("{} and {} more", names, files.size() - kMost);
}

}  // namespace voxdag::cli
