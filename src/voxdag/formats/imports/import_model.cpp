#include "voxdag/formats/imports/import_model.hpp"

#include <utility>

namespace voxdag {

ImportedModel import_model(const VoxelSource& source, const ImportOptions& options,
                           const std::string& name, Work work, const TransformRequest& transform) {
  ImportResult result = import_voxels(source, options, work);
  VdagMetadata metadata;
  metadata.grid = result.grid;
  metadata.source = {name, result.read, 0};
  metadata.build = {{"cover", "imported"}};
  add_settings(transform, metadata.build);
  if (result.attributes.view().has_colors()) {
    metadata.attributes.resolution = result.grid.resolution();
    metadata.attributes.colors = {color_bound_of(source, options),
                                  result.attributes.color_errors.squared};
  }
  return {DagModel(std::move(result.dag), std::move(result.attributes), std::move(metadata), work),
          result.read, result.outside, result.not_finite};
}

}  // namespace voxdag
