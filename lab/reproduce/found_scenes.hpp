#pragma once
/// Finds the meshes that stand for the scenes of the papers.
#include <filesystem>
#include <optional>
#include <vector>

#include "lab/papers/paper_scenes.hpp"
#include "lab/report/document.hpp"
#include "lab/reproduce/cells.hpp"
#include "lab/reproduce/papers_plan.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag::lab {

/// A scene of a paper, and the mesh that stands for it.
struct FoundScene {
  const PaperScene* scene = nullptr;
  PaperMatch match;            ///< Its scene is null if no mesh stands for it.
  MeshIdentity identity;       ///< Of the mesh.
  std::filesystem::path mesh;  ///< Empty if no mesh stands for it.
  SceneOptions made_with;      ///< How the mesh was made, if it is procedural.
  std::vector<std::string>
      options;  ///< Of `build` for an ESVO: the displacement, if the scene has one.

  bool is_absent() const { return mesh.empty(); }
  /// Returns "Lucy (variant)".
  std::string title() const;
  /// Returns whether the paper's figures belong into the tables: beside ours, or without ours.
  bool shows_published() const { return match.has_figures() || is_absent(); }
  /// Returns "same", "variant", "stand-in" or "absent".
  std::string state() const;
};

/// Returns the scenes of a paper in the order of its tables, each with the best mesh that is there:
/// first the paper's own, then a variant, then a stand-in. Looks in the plan's folder of scenes and
/// below; makes procedural stand-ins in `made`. Registers the meshes as inputs of the cells. Throws
/// Error if the folder cannot be read, and Cancelled.
std::vector<FoundScene> find_scenes(Paper paper, const PapersPlan& plan,
                                    const std::filesystem::path& made, CellStore& cells,
                                    Progress& progress);

/// Returns a camera, a sun and a flight that show the scene well; nothing if none are known.
std::optional<ScenePreset> preset_of(const FoundScene& scene);

/// Returns a table of the scenes, their states and their meshes.
Section scenes_section(const std::vector<FoundScene>& scenes);

}  // namespace voxdag::lab
