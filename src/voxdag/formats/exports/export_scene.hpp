#pragma once
/// Exports scenes, turned so that the axis that the user or the format's custom names points up.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/scene_metadata.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"

namespace voxdag {

/// Returns the axis that points up in a scene's world, 'y' or 'z': that of the metadata (build
/// setting "up"), else by the custom of its source's format: y for glTF, z for .vox, STL, 3MF and
/// LAS. Returns nothing for others.
std::optional<char> up_of(const SceneMetadata& metadata);

/// Calls export_voxels(). Before, turns the scene about the x axis if content.up is another axis
/// than up_of() says, or if content.up is not given and the format has a custom: y up for .glb and
/// .schem, z up for .vox and .stl. If up_of() says nothing, a given content.up turns the scene, and
/// the custom does not. ESVOs cannot be turned: that is an error if content.up is given, else a
/// note. Counts the turned DAG in `work`.
std::vector<std::filesystem::path> export_scene(const std::filesystem::path& path,
                                                const VoxelSet& voxels,
                                                const SceneMetadata& metadata,
                                                const ExportContent& content, ExportOptions options,
                                                Work work = {});

}  // namespace voxdag
