#include "build/build_arguments.hpp"

#include <fmt/core.h>

#include <stdexcept>

#include "cli/parse.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

Grid choose_grid(const Mesh& mesh, const std::optional<Box3d>& surface,
                 const BuildArguments& arguments) {
  if (arguments.bounds || surface) {
    const Box3d& bounds = arguments.bounds ? *arguments.bounds : *surface;
    return arguments.levels ? grid_from_bounds(bounds, *arguments.levels)
                            : grid_from_bounds(bounds, *arguments.voxel_size);
  }
  return arguments.levels ? fit_grid(mesh, *arguments.levels)
                          : grid_from_voxel_size(mesh, *arguments.voxel_size);
}

std::string name_of(SolidRule rule) {
  switch (rule) {
    case SolidRule::kParity:
      return "parity";
    case SolidRule::kWinding:
      return "winding";
    case SolidRule::kFlood:
      break;
  }
  return "flood";
}

SolidOptions solid_options(const std::map<std::string, std::string>& settings) {
  SolidOptions options;
  options.rule = solid_rule(settings.at("solid"));
  if (const auto threshold = settings.find("winding_threshold"); threshold != settings.end())
    options.winding_threshold = parse_positive(threshold->second);
  return options;
}

SolidRule solid_rule(const std::string& name) {
  if (name == "parity") return SolidRule::kParity;
  if (name == "winding") return SolidRule::kWinding;
  if (name == "flood") return SolidRule::kFlood;
  throw std::invalid_argument("\"" + name + "\" is none of parity, winding and flood");
}

std::map<std::string, std::string> grid_settings(const BuildArguments& arguments) {
  std::map<std::string, std::string> settings = {
      {"cover", "exact"},
      {"grid_from", arguments.bounds ? "bounds" : "mesh"},
      {"scale_from", arguments.levels ? "resolution" : "voxel_size"}};
  if (arguments.solid) {
    settings["solid"] = name_of(*arguments.solid);
    if (*arguments.solid == SolidRule::kWinding)
      settings["winding_threshold"] = fmt::format("{}", arguments.winding_threshold);
  }
  return settings;
}

}  // namespace voxdag
