#pragma once
/// The option --look names a file: hits at a DAG get its colours and normals.
#include <optional>
#include <string>

#include "cli/session.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag::cli {

Option add_look_option(const Command& command, std::string& file);

/// Opens the file of --look for the voxels in `scene`; returns nothing if `file` is empty. Throws
/// Error unless the file is an ESVO or a DAG with attributes, `scene` is a DAG, and their grids
/// have the same place in the world. Their resolutions may differ.
std::optional<SceneModel> open_look(const std::string& file, const SceneModel& scene,
                                    Session& session);

/// Returns the colours and normals that a file stores; empty if it stores none.
LookView look_of(const SceneModel& file);

}  // namespace voxdag::cli
