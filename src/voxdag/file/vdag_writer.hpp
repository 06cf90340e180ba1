#pragma once
/// Writes a DAG as a .vdag file.
#include <filesystem>

#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/layout/svdag.hpp"

namespace voxdag {

/// The file appears under `path` when it is complete (see AtomicFile) and its bytes depend on the
/// arguments alone. metadata.grid.levels must equal view.levels. Throws Error where it cannot be
/// written, or where the grid has values that no file may hold (see parse_vdag_metadata).
void write_vdag(const std::filesystem::path& path, const SvdagView& view,
                const VdagMetadata& metadata);

}  // namespace voxdag
