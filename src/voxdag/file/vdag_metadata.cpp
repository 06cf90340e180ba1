#include "voxdag/file/vdag_metadata.hpp"

#include "voxdag/file/metadata_json.hpp"

namespace voxdag {

std::string vdag_metadata_json(const VdagMetadata& metadata) {
  MetadataJson json = begin_metadata_json(metadata);
  json["counts"] = {{"voxels", metadata.counts.voxels},
                    {"svo_nodes_per_level", metadata.counts.svo_nodes_per_level},
                    {"dag_nodes_per_level", metadata.counts.dag_nodes_per_level}};
  finish_metadata_json(json, metadata);
  return metadata_text(json);
}

VdagMetadata parse_vdag_metadata(std::string_view text) {
  const MetadataJson json = parse_metadata_json(text);
  const MetadataField root{json, ""};
  VdagMetadata metadata;
  read_scene_metadata(root, metadata);
  const auto levels = static_cast<std::size_t>(metadata.grid.levels);
  const MetadataField counts = root.at("counts");
  metadata.counts.voxels = counts.at("voxels").count();
  metadata.counts.svo_nodes_per_level = counts.at("svo_nodes_per_level").counts(levels);
  metadata.counts.dag_nodes_per_level = counts.at("dag_nodes_per_level").counts(levels);
  return metadata;
}

}  // namespace voxdag
