#pragma once
/// Reports the counts and sizes of a DAG as tables and as JSON, for `build` and `info`.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/layout/stored_attributes.hpp"

namespace voxdag {

/// Counts and bytes of a DAG's attributes; 0 without them.
struct AttributeSizes {
  std::uint64_t cells = 0;
  std::uint64_t index_bytes = 0, color_bytes = 0, normal_bytes = 0;
};
AttributeSizes sizes_of(const DagAttributesView& attributes);

struct DagReport {
  VdagMetadata metadata;
  std::uint64_t svdag_bytes = 0;  ///< SvdagView::bytes()
  std::uint64_t file_bytes = 0;
  AttributeSizes attributes;
};

/// Returns the keys of `info --json`; docs/cli.md lists them.
nlohmann::ordered_json dag_json(const DagReport& report);

/// Returns the placement, then SVO and DAG side by side: nodes, bytes, bits per voxel.
std::string dag_table(const DagReport& report);

/// Adds the keys of all kinds of voxels: "transform", "source", "program" and "build".
void add_placement_json(nlohmann::ordered_json& json, const Grid& grid, const VdagSource& source,
                        const std::string& program,
                        const std::map<std::string, std::string>& build);

/// Returns the mesh and the grid, a line each. The name of the mesh is made printable.
std::string placement_table(const Grid& grid, const VdagSource& source);

/// Returns the nodes of SVO and DAG side by side, a line per level.
std::string level_table(const SvdagCounts& counts);

}  // namespace voxdag
