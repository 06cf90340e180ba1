#include "voxdag/file/esvo_metadata.hpp"

#include <algorithm>

#include "voxdag/file/metadata_json.hpp"

namespace voxdag {

std::string esvo_metadata_json(const EsvoMetadata& metadata) {
  const EsvoCounts& counts = metadata.counts;
  const auto used_levels = [&](const EsvoCounts::PerLevel& values) {
    return std::vector<std::uint64_t>(values.begin(), values.begin() + metadata.grid.levels + 1);
  };
  MetadataJson json = begin_metadata_json(metadata);
  json["root"] = metadata.root;
  json["counts"] = {{"voxels_per_level", used_levels(counts.voxels_per_level)},
                    {"leaves_per_level", used_levels(counts.leaves_per_level)},
                    {"descriptors", counts.descriptors},
                    {"far_pointers", counts.far_pointers},
                    {"contours", counts.contours},
                    {"blocks", counts.blocks}};
  finish_metadata_json(json, metadata);
  return metadata_text(json);
}

EsvoMetadata parse_esvo_metadata(std::string_view text) {
  const MetadataJson json = parse_metadata_json(text);
  const MetadataField root{json, ""};
  EsvoMetadata metadata;
  read_scene_metadata(root, metadata);
  metadata.root = root.at("root").count();
  const MetadataField counts = root.at("counts");
  const auto read_levels = [&](const char* name, EsvoCounts::PerLevel& values) {
    const std::vector<std::uint64_t> read =
        counts.at(name).counts(static_cast<std::size_t>(metadata.grid.levels) + 1);
    std::copy(read.begin(), read.end(), values.begin());
  };
  read_levels("voxels_per_level", metadata.counts.voxels_per_level);
  read_levels("leaves_per_level", metadata.counts.leaves_per_level);
  metadata.counts.descriptors = counts.at("descriptors").count();
  metadata.counts.far_pointers = counts.at("far_pointers").count();
  metadata.counts.contours = counts.at("contours").count();
  metadata.counts.blocks = counts.at("blocks").count();
  return metadata;
}

}  // namespace voxdag
