#include "build/attribute_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "cli/input_files.hpp"
#include "cli/parse.hpp"
#include "cli/usage_error.hpp"
#include "voxdag/builders/attributes/inside_attributes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/mesh/join_meshes.hpp"

namespace voxdag::cli {

namespace {

/// Parses the value of --alpha. Returns whether it is "cut".
bool parse_cut(const std::string& text) {
  if (text != "cut" && text != "keep")
    throw std::invalid_argument(fmt::format("\"{}\" is neither cut nor keep", text));
  return text == "cut";
}

/// Returns the options with the channels that --channel names.
AttributeOptions with_channels(const std::string& text, AttributeOptions options) {
  for (const std::string& name : parse_words(text)) options.add_channel(name);
  return options;
}

IdKind parse_ids(const std::string& text) {
  if (text == "material") return IdKind::kMaterial;
  if (text == "object") return IdKind::kObject;
  if (text == "file") return IdKind::kFile;
  throw std::invalid_argument("\"" + text + "\" is none of file, object and material");
}

}  // namespace

void add_attribute_options(const Command& command, AttributeArguments& arguments,
                           const std::string& group, const std::function<bool()>& is_solid) {
  AttributeOptions& options = arguments.options;
  const auto is_wanted = [&arguments] { return arguments.is_wanted(); };
  command
      .flag("--color", options.colors,
            "Also store the colours of all cells, filtered from textures, vertex colours and "
            "materials")
      .in_group(group);
  command
      .flag("--color-if-any", arguments.colors_if_any,
            "As --color, if the mesh has textures, colours of vertices or coloured materials")
      .in_group(group);
  command.flag("--normal", options.normals, "Also store the normals of all cells").in_group(group);
  command
      .flag("--material-ids", options.materials,
            "Also store the material of all cells, as its number in the mesh: the one with the "
            "largest area in the cell. If the mesh has no materials: its objects")
      .in_group(group);
  command
      .parsed(
          "--ids", arguments.ids,
          [&options](const std::string& text) {
            options.materials = true;
            return parse_ids(text);
          },
          "file|object|material",
          "Store the ids of files, objects or materials. Files are numbered in the order of the "
          "command line, objects (`o` and `g` of OBJ, nodes of glTF) in that of the file. `voxdag "
          "info` shows the names")
      .in_group(group);
  command
      .parsed(
          "--channel", options,
          [&options](const std::string& text) { return with_channels(text, options); },
          "metallic|roughness,...",
          "Also store these numbers of the materials of glTF and OBJ, filtered from textures as "
          "colours are, as channels of all cells: 0 to 255. `voxdag render` shows them")
      .in_group(group);
  command
      .parsed(
          "--attribute-resolution", arguments.levels, parse_levels, "M",
          "Resolution of the finest colours, normals, materials and channels, in cells per side: a "
          "power of two from 4 to the grid's resolution (default: the finest that is expected to "
          "fit into 4 GiB and the memory limit)")
      .only_if(is_wanted, "without --color, --normal, --material-ids and --channel")
      .in_group(group);
  command
      .parsed(
          "--alpha", arguments.cut, parse_cut, "cut|keep",
          "Voxels whose whole surface is transparent, by textures, materials or vertex colours. "
          "cut: leave them empty; keep: set them, with the nearest visible colour (default: cut "
          "with --color, else keep). An ESVO never has them")
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
  command
      .parsed("--inside-color", arguments.inside_color, parse_color, "R,G,B",
              "Colour of the voxels inside a solid, 0 to 255 each (default: that of the nearest "
              "surface)")
      .only_if(is_solid, "without --solid")
      .only_if([&options] { return options.colors; }, "without --color")
      .in_group(group);
}

void AttributeArguments::check_levels(int dag_levels) const {
  if (levels && *levels > dag_levels)
    throw UsageError("--attribute-resolution",
                     fmt::format("{} is more than the grid's resolution, {}",
                                 std::int64_t{1} << *levels, std::int64_t{1} << dag_levels));
}

NamedIds named_ids(IdKind kind, const JoinedMeshes& meshes, const std::vector<std::string>& files,
                   MemoryBudget* memory) {
  const Mesh& mesh = meshes.source.mesh;
  const std::string& first = files.front();
  NamedIds result{CountedVector<std::uint32_t>(memory), mesh.materials, "material"};
  if (kind == IdKind::kDefault)
    kind = mesh.triangle_materials.empty() && !mesh.objects.empty() ? IdKind::kObject
                                                                    : IdKind::kMaterial;
  if (kind == IdKind::kMaterial && mesh.triangle_materials.empty())
    throw Error(first, "", "has no materials, so that --material-ids has nothing to store");
  if (kind != IdKind::kMaterial) {
    result.kind = kind == IdKind::kFile ? "file" : "object";
    if (kind == IdKind::kObject && !mesh.objects.empty()) {
      result.names = mesh.objects;
      result.ids = ids_of_runs(mesh.object_runs, mesh.triangles.size(), memory);
    } else {  // A file without objects is one object.
      result.names = distinct_names(files);
      result.ids = ids_of_runs(meshes.files, mesh.triangles.size(), memory);
    }
  }
  if (result.names.size() > kMaxMaterials)
    throw Error(first, "",
                fmt::format("has {} {}s, but --material-ids can store {} at most",
                            result.names.size(), result.kind, kMaxMaterials));
  return result;
}

DagAttributes build_wanted_attributes(const AttributeArguments& arguments,
                                      const MeshWithAppearance& source, const NamedIds& ids,
                                      const SvdagView& dag, const SvdagView* cover,
                                      const SurfaceShading* shading, VdagMetadata& metadata,
                                      Work work) {
  AttributeOptions options = arguments.options;
  options.ids = ids.view();
  options.finest_level = arguments.levels
                             ? *arguments.levels
                             : finest_level_within(metadata.counts, options,
                                                   std::min(kAttributeBudget, work.memory->left()));
  AttributeOptions exact = options;
  if (cover != nullptr) exact.color_bound = 0, exact.normal_bound_degrees = kMinNormalBound;
  DagAttributes attributes = build_attributes(
      source.mesh, metadata.grid, cover != nullptr ? *cover : dag, shading, exact, work);
  if (cover != nullptr) {
    const MemoryReservation surface(work.memory, attributes.bytes());
    attributes =
        inside_attributes({*cover, attributes.view()}, dag, options, arguments.inside_color, work);
  }
  AttributesMetadata& stored = metadata.attributes;
  stored.resolution = std::int64_t{1} << options.finest_level;
  if (options.colors) stored.colors = {options.color_bound, attributes.color_errors.squared};
  if (options.normals)
    stored.normals = {options.normal_bound_degrees, attributes.normal_errors.absolute};
  if (!options.materials) return attributes;
  stored.materials = ids.names;
  if (!ids.ids.empty()) metadata.build["ids"] = ids.kind;
  return attributes;
}

}  // namespace voxdag::cli
