#include "voxdag/file/vdag_metadata.hpp"

#include "voxdag/file/metadata_json.hpp"

namespace voxdag {

std::string vdag_metadata_json(const VdagMetadata& metadata) {
  MetadataJson json;
  json["grid"] = grid_json(metadata.grid);
  json["counts"] = {{"voxels", metadata.counts.voxels},
                    {"svo_nodes_per_level", metadata.counts.svo_nodes_per_level},
                    {"dag_nodes_per_level", metadata.counts.dag_nodes_per_level}};
  add_origin_json(json, metadata.source, metadata.program, metadata.build);
  return metadata_text(json);
}

VdagMetadata parse_vdag_metadata(std::string_view text) {
  const MetadataJson json = parse_metadata_json(text);
  const MetadataField root{json, ""};
  VdagMetadata metadata;
  metadata.grid = read_grid(root.at("grid"));
  const auto levels = static_cast<std::size_t>(metadata.grid.levels);
  const MetadataField counts = root.at("counts");
  metadata.counts.voxels = counts.at("voxels").count();
  metadata.counts.svo_nodes_per_level = counts.at("svo_nodes_per_level").counts(levels);
  metadata.counts.dag_nodes_per_level = counts.at("dag_nodes_per_level").counts(levels);
  metadata.source = read_source(root.at("source"));
  metadata.program = root.at("program").text();
  metadata.build = read_build(root.at("build"));
  return metadata;
}

}  // namespace voxdag
