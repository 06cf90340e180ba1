#pragma once
/// Writes an edited scene to a file.
#include <filesystem>

#include "voxdag/edit/editable_dag.hpp"
#include "voxdag/file/vdag_metadata.hpp"

namespace voxdag {

/// Saves a version of the scene whose file had `metadata`; `compact` chooses the compact form.
/// Throws Error, OverMemory and Cancelled.
void save_edited(const EditSnapshot& version, VdagMetadata metadata,
                 const std::filesystem::path& path, bool compact, Work work);

}  // namespace voxdag
