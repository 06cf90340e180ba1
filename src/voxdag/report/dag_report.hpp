#pragma once
/// What a DAG holds and takes, as a table and as JSON: `build` and `info` show the same.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "voxdag/file/vdag_metadata.hpp"

namespace voxdag {

struct DagReport {
  VdagMetadata metadata;
  std::uint64_t svdag_bytes = 0;  ///< SvdagView::bytes()
  std::uint64_t file_bytes = 0;
};

/// The keys of `info --json`; docs/cli.md lists them.
nlohmann::ordered_json dag_json(const DagReport& report);

/// Grid and placement, then SVO and DAG side by side: nodes, bytes, bits per voxel.
std::string dag_table(const DagReport& report);

/// What all kinds of voxels have: "transform", "source", "program" and "build".
void add_placement_json(nlohmann::ordered_json& json, const Grid& grid, const VdagSource& source,
                        const std::string& program,
                        const std::map<std::string, std::string>& build);

/// The mesh and the grid, a line each.
std::string placement_table(const Grid& grid, const VdagSource& source);

/// Nodes of SVO and DAG side by side for each level.
std::string level_table(const SvdagCounts& counts);

}  // namespace voxdag
