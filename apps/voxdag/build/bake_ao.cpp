#include "build/bake_ao.hpp"

#include <fmt/core.h>

#include "cli/parse.hpp"
#include "cli/usage_error.hpp"

namespace voxdag::cli {
namespace {

/// Returns a grid of the cube of `grid` with 2^levels voxels a side, at most as many as `grid` has.
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
  command
      .parsed("--ao-resolution", arguments.levels, parse_levels, "N",
              "With --bake-ao: voxels per side of the octree at which the rays are cast, at most "
              "those of the ESVO; fewer take less memory (default: those of the ESVO)")
      .needs(bake)
      .in_group(group);
}

void BakeArguments::check_levels(int esvo_levels) const {
  if (levels && *levels > esvo_levels)
    throw UsageError("--ao-resolution",
                     fmt::format("{} is more than the ESVO's resolution, {}",
                                 std::int64_t{1} << *levels, std::int64_t{1} << esvo_levels));
}

void add_bake_settings(const BakeArguments& arguments, const Grid& grid,
                       std::map<std::string, std::string>& settings) {
  if (arguments.rays == 0) return;
  settings["bake_ao_rays"] = std::to_string(arguments.rays);
  settings["bake_ao_distance"] = fmt::format("{}", arguments.distance_in(grid));
  settings["bake_ao_resolution"] = std::to_string(std::int64_t{1} << arguments.levels_in(grid));
}

Occluders::Occluders(const Mesh& mesh, const Grid& grid, const BakeArguments& arguments,
                     const EsvoOptions& build, const SurfaceShading& shading,
                     const DisplacedTriangles* displaced, Work work)
    : grid_(grid), work_(work) {
  const Grid own = coarser(grid, arguments.levels_in(grid));
  EsvoOptions options = build;
  options.settings.attributes = false;
  options.stage = "occluders";
  EsvoMemory memory(work.memory);
  const EsvoResult result = build_esvo(mesh, own, options, &shading, displaced, memory, work);
  esvo_ = {memory.take(), result.root, own.levels};
  memory_ = {work.memory, esvo_.slots.capacity() * sizeof(std::uint64_t)};
  openness_.emplace(esvo_.view(), own, arguments.rays, arguments.distance_in(grid));
}

SurfaceLight Occluders::light() const {
  return [this](const SurfacePlace& place) {
    work_.poll();  // A task may cast millions of rays.
    return (*openness_)(grid_.to_world(place.point), place.normal, place.face);
  };
}

}  // namespace voxdag::cli
