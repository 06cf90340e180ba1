#pragma once
/// What a DAG holds and takes, as a table and as JSON: `build` and `info` show the same.
#include <cstdint>
#include <nlohmann/json.hpp>
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

/// Nodes of SVO and DAG side by side for each level.
std::string level_table(const SvdagCounts& counts);

}  // namespace voxdag
