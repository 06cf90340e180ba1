#pragma once
/// Reports the counts and sizes of a DAG as tables and as JSON, for `build` and `info`.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A channel, and the least and the greatest of its values.
struct ChannelReport {
  ChannelSpec spec;
  std::uint64_t bytes = 0;
  ChannelRange range;
};

/// Counts and bytes of a DAG's attributes; all 0 if it has none.
struct AttributeSizes {
  std::uint64_t cells = 0;
  std::uint64_t index_bytes = 0, color_bytes = 0, normal_bytes = 0, material_bytes = 0;
  bool is_wire = false;  ///< Colours and normals have the wire form.
  std::vector<ChannelReport> channels = {};

  std::uint64_t channel_bytes() const;
};
/// Reads all values of channels.
AttributeSizes sizes_of(const DagAttributesView& attributes);

/// The bytes of a DAG in the compact form, by part.
struct CompactBytes {
  std::uint64_t head = 0;   ///< Context trees, their tables, and the lengths of shared nodes.
  std::uint64_t nodes = 0;  ///< Nodes above the units.
  std::uint64_t units = 0;  ///< Units with their inline bricks.
  std::uint64_t shared_bricks = 0;
  std::vector<std::uint64_t> shared_nodes_per_level;  ///< Nodes with two or more pointers to them.
  std::uint64_t total() const { return head + nodes + units + shared_bricks; }
};

struct DagReport {
  VdagMetadata metadata;
  std::uint64_t node_bytes = 0;  ///< Of nodes above the leaf blocks, in the paper's layout.
  std::uint64_t leaf_bytes = 0;  ///< Of leaf blocks, in the paper's layout.
  std::uint64_t file_bytes = 0;
  std::optional<CompactBytes> compact;  ///< If the file has this form.
  AttributeSizes attributes;

  std::uint64_t svdag_bytes() const { return node_bytes + leaf_bytes; }
};

/// Returns a report of the file with this DAG, an SvdagView or a LongSvdagView.
template <class Dag>
DagReport report_of(const Dag& dag, const VdagMetadata& metadata, std::uint64_t file_bytes) {
  return {metadata, dag.node_words() * 4, dag.leaf_block_count * 8, file_bytes, std::nullopt, {}};
}

/// Returns the bytes of a compact DAG whose head has `head_bytes`.
CompactBytes bytes_of(const CompactSvdagView& compact, std::uint64_t head_bytes);

/// Returns the keys of `info --json`; docs/json.md lists them.
nlohmann::ordered_json dag_json(const DagReport& report);

/// Returns the placement, then SVO and DAG side by side: nodes, bytes, bits per voxel.
std::string dag_table(const DagReport& report);

/// Adds the keys of all kinds of voxels: "transform", "source", "program" and "build".
void add_placement_json(nlohmann::ordered_json& json, const SceneMetadata& metadata);

/// Returns the mesh and the grid, a line each. The name of the mesh is made printable.
std::string placement_table(const SceneMetadata& metadata);

/// Returns the nodes of SVO and DAG side by side, a line per level.
std::string level_table(const SvdagCounts& counts);

}  // namespace voxdag
