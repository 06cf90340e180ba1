#include "build/attribute_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "cli/parse.hpp"
#include "cli/usage_error.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {

namespace {

/// Returns whether the text asks to cut.
bool parse_cut(const std::string& text) {
  if (text != "cut" && text != "keep")
    throw std::invalid_argument(fmt::format("\"{}\" is neither cut nor keep", text));
  return text == "cut";
}

}  // namespace

void add_attribute_options(const Command& command, AttributeArguments& arguments,
                           const std::string& group) {
  AttributeOptions& options = arguments.options;
  const auto is_wanted = [&arguments] { return arguments.is_wanted(); };
  command
      .flag("--color", options.colors,
            "Also store the colours of all cells, filtered from textures, vertex colours and "
            "materials")
      .in_group(group);
  command.flag("--normal", options.normals, "Also store the normals of all cells").in_group(group);
  command
      .flag("--material-ids", options.materials,
            "Also store the material of all cells, as its number in the mesh: the one with the "
            "largest area in the cell")
      .in_group(group);
  command
      .parsed(
          "--attribute-resolution", arguments.levels, parse_levels, "M",
          "Resolution of the finest colours, normals and materials, in cells per side: a power of "
          "two from 4 to the grid's resolution (default: the finest that is expected to fit into "
          "4 GiB and the memory limit)")
      .only_if(is_wanted, "without --color, --normal and --material-ids")
      .in_group(group);
  command
      .parsed("--alpha", arguments.cut, parse_cut, "cut|keep",
              "Voxels whose surface is transparent, by textures, materials or vertex colours. cut: "
              "they are not set; keep: they are set, and have the nearest visible colour (default: "
              "cut with --color, else keep). An ESVO never has them")
      .in_group(group);
  command
      .number("--color-bound", options.color_bound, NumberRange::from(0, 1), "DIFFERENCE",
              "Largest error of a stored colour, 0 to 1: the root of the weighted mean of the "
              "channels' squared differences, sRGB encoded (0: lossless)")
      .only_if([&options] { return options.colors; }, "without --color")
      .in_group(group);
  command
      .number("--normal-bound", options.normal_bound_degrees,
              NumberRange::from(kMinNormalBound, 180), "DEGREES",
              "Largest angle between a stored normal and the filtered one")
      .only_if([&options] { return options.normals; }, "without --normal")
      .in_group(group);
}

void AttributeArguments::check_levels(int dag_levels) const {
  if (levels && *levels > dag_levels)
    throw UsageError("--attribute-resolution",
                     fmt::format("{} is more than the grid's resolution, {}",
                                 std::int64_t{1} << *levels, std::int64_t{1} << dag_levels));
}

void check_materials(const AttributeArguments& arguments, const Mesh& mesh,
                     const std::string& file) {
  if (!arguments.options.materials) return;
  if (mesh.triangle_materials.empty())
    throw Error(file, "", "has no materials, so that --material-ids has nothing to store");
  if (mesh.materials.size() > kMaxMaterials)
    throw Error(file, "",
                fmt::format("has {} materials, but --material-ids can store {} at most",
                            mesh.materials.size(), kMaxMaterials));
}

DagAttributes build_wanted_attributes(const AttributeArguments& arguments,
                                      const MeshWithAppearance& source, const SvdagView& dag,
                                      const SurfaceShading* shading, VdagMetadata& metadata,
                                      Work work) {
  AttributeOptions options = arguments.options;
  options.finest_level = arguments.levels
                             ? *arguments.levels
                             : finest_level_within(metadata.counts, options,
                                                   std::min(kAttributeBudget, work.memory->left()));
  DagAttributes attributes =
      build_attributes(source.mesh, metadata.grid, dag, shading, options, work);
  AttributesMetadata& stored = metadata.attributes;
  stored.resolution = std::int64_t{1} << options.finest_level;
  if (options.colors) stored.colors = {options.color_bound, attributes.color_errors.squared};
  if (options.normals)
    stored.normals = {options.normal_bound_degrees, attributes.normal_errors.absolute};
  if (options.materials) stored.materials = source.mesh.materials;
  return attributes;
}

}  // namespace voxdag::cli
