#pragma once
/// Writes the .vdag file of a DAG whose words lie in the files of a job.
#include <filesystem>

#include "voxdag/cluster/node_order.hpp"
#include "voxdag/file/vdag_metadata.hpp"

namespace voxdag {

/// Writes the file that write_vdag() writes for this DAG and metadata. Each rank writes the runs of
/// its mailboxes. Collective. `metadata` counts on rank 0. Throws Error and Cancelled.
void write_vdag_from_runs(const MergeJob& job, const OrderedDag& dag, const VdagMetadata& metadata,
                          const std::filesystem::path& path);

}  // namespace voxdag
