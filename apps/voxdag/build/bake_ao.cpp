#include "build/bake_ao.hpp"

#include <fmt/core.h>

#include "cli/parse.hpp"

namespace voxdag {
namespace {

/// Returns a grid of the cube of `grid` with at most 2^levels voxels a side.
Grid coarser(Grid grid, int levels) {
  for (; grid.levels > levels; --grid.levels) {
    grid.voxel_size *= 2;
    grid.quantization_scale /= 2;
  }
  return grid;
}

}  // namespace

void add_bake_options(const Command& command, BakeArguments& arguments,
                      const std::function<bool()>& has_colors, const std::string& group) {
  constexpr int kRays = 64;
  const Option bake =
      command
          .flag_or_number("--bake-ao", arguments.rays, NumberRange::whole(1, 4096), kRays, "RAYS",
                          "Darken colours by ambient occlusion, with RAYS rays per point")
          .only_if(has_colors, "with --no-attributes")
          .in_group(group);
  command
      .parsed("--ao-distance", arguments.distance, parse_positive, "LENGTH",
              "With --bake-ao: length of the rays, in world units (default: 0.15 of the grid's "
              "side)")
      .needs(bake)
      .in_group(group);
}

void add_bake_settings(const BakeArguments& arguments, const Grid& grid,
                       std::map<std::string, std::string>& settings) {
  if (arguments.rays == 0) return;
  settings["bake_ao_rays"] = std::to_string(arguments.rays);
  settings["bake_ao_distance"] = fmt::format("{}", arguments.distance_in(grid));
}

Occluders::Occluders(const Mesh& mesh, const Grid& grid, const BakeArguments& arguments,
                     const EsvoOptions& build, const SurfaceShading& shading,
                     const DisplacedTriangles* displaced, Progress& progress)
    : grid_(grid) {
  constexpr int kFinest = 10;
  const Grid own = coarser(grid, kFinest);
  EsvoOptions options = build;
  options.settings.attributes = false;
  EsvoMemory memory(options.memory);
  const EsvoResult result = build_esvo(mesh, own, options, &shading, displaced, memory, &progress);
  esvo_ = {memory.take(), result.root, own.levels};
  memory_ = {options.memory, esvo_.slots.size() * sizeof(std::uint64_t)};
  openness_.emplace(esvo_.view(), own, arguments.rays, arguments.distance_in(grid));
}

SurfaceLight Occluders::light() const {
  return [this](const SurfacePlace& place) {
    return (*openness_)(grid_.to_world(place.point), place.normal, place.face);
  };
}

}  // namespace voxdag
