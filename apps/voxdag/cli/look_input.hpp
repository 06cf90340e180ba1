#pragma once
/// The option --look: an ESVO whose colours and normals the hits at a DAG get.
#include <optional>
#include <string>

#include "cli/scene_input.hpp"
#include "cli/session.hpp"

namespace voxdag {

Option add_look_option(const Command& command, std::string& file);

/// Opens the ESVO of --look for the voxels in `scene`; returns nothing if `file` is empty. Throws
/// Error unless the file is an ESVO, `scene` is a DAG, and their grids have the same place in the
/// world. Their resolutions may differ.
std::optional<SceneInput> open_look(const std::string& file, const SceneInput& scene,
                                    Session& session);

}  // namespace voxdag
