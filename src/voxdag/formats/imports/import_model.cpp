#include "voxdag/formats/imports/import_model.hpp"

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/number_text.hpp"

namespace voxdag {

void check_grid_options(const VoxelSource& source, const ImportOptions& options) {
  const SplatOptions& splats = options.splats;
  if (!source.has_splats() && (splats.opacity || splats.min_scale || splats.max_scale))
    throw Error("", "",
                "is not read as splats: --opacity, --min-scale and --max-scale are for those");
  if (!options.labels.empty() && !source.has_labels())
    throw Error("", "", "is read without labels: --keep and --drop need --labels");
  const bool sets_place = options.voxel_size || options.origin;
  if (source.has_points()) {
    if (!options.resolution && !options.voxel_size && !source.grid())
      throw Error("", "", "holds points, which need a resolution or a voxel size");
    if (options.resolution && options.voxel_size)
      throw Error("", "", "holds points: give -r or --voxel-size, not both");
    if (options.origin && (options.bounds || (!options.voxel_size && !options.resolution)))
      throw Error("", "",
                  "holds points; --origin goes with -r or --voxel-size, and not with --bounds");
  } else if (options.bounds) {
    throw Error("", "", "holds voxels; --bounds is for points");
  } else if (options.snap || options.padding != 0 || options.center) {
    throw Error("", "", "holds voxels; --snap, --padding and --center are for points");
  } else if (sets_place && source.has_place()) {
    throw Error("", "",
                "says itself where its voxels lie: --voxel-size and --origin are for files that do "
                "not");
  }
}

ImportedModel import_model(const VoxelSource& source, const ImportOptions& options,
                           const std::string& name, Work work, const TransformRequest& transform) {
  ImportResult result = import_voxels(source, options, work);
  VdagMetadata metadata;
  metadata.grid = result.grid;
  metadata.source = {name, result.read, 0};
  metadata.build = {{"cover", "imported"}};
  if (const std::optional<char> up = source.up()) metadata.build["up"] = std::string(1, *up);
  add_settings(transform, metadata.build);
  if (source.has_splats()) {
    metadata.build["cover"] = "splats";
    metadata.build["opacity"] = number_text(*result.splats.opacity);
    metadata.build["min_scale"] = number_text(*result.splats.min_scale);
    metadata.build["max_scale"] = number_text(*result.splats.max_scale);
  }
  if (!result.attributes.view().is_empty())
    metadata.attributes.resolution = result.grid.resolution();
  if (result.attributes.view().has_colors()) {
    metadata.attributes.colors = {color_bound_of(source, options),
                                  result.attributes.color_errors.squared};
  }
  if (result.attributes.view().has_materials()) {
    metadata.attributes.materials = std::move(result.label_names);
    metadata.attributes.labels = std::move(result.labels);
  }
  return {DagModel(std::move(result.dag), std::move(result.attributes), std::move(metadata), work),
          result.read,
          result.outside,
          result.unwanted,
          result.not_finite,
          result.too_large};
}

}  // namespace voxdag
