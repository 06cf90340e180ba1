#pragma once
/// Reads what exports say about the place of their voxels.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "voxdag/core/orientation.hpp"

namespace voxdag {

/// Returns the placement that write_placement() wrote to `file`. Returns null if there is no such
/// file, or if another program wrote it.
nlohmann::json read_placement(const std::filesystem::path& file);

/// Returns the offset that the placement beside `file` adds to the file's coordinates; 0 without
/// one.
Vec3d offset_beside(const std::filesystem::path& file);

/// Returns how an export turns a scene whose axis `from_up` ('y' or 'z') points up, so that the
/// other one does.
Orientation turn_of_export(char from_up);

}  // namespace voxdag
