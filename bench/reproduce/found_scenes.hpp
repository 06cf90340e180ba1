#pragma once
/// Finds the meshes that stand for the scenes of the papers.
#include <filesystem>
#include <vector>

#include "bench/papers/paper_scenes.hpp"
#include "bench/reproduce/cells.hpp"

namespace voxdag {

/// A scene of a paper, and the mesh that stands for it.
struct FoundScene {
  const PaperScene* scene = nullptr;
  PaperMatch match;            ///< Its scene is null if no mesh stands for it.
  MeshIdentity identity;       ///< Of the mesh.
  std::filesystem::path mesh;  ///< Empty if no mesh stands for it.

  bool is_absent() const { return mesh.empty(); }
  /// Returns "same", "variant", "stand-in" or "absent".
  std::string state() const;
};

/// Returns the scenes of a paper in the order of its tables, each with the best mesh that is there:
/// first the paper's own, then a variant, then a stand-in. Looks in `folder` (empty: none) and
/// below; makes procedural stand-ins in `made`. Registers the meshes as inputs of the cells. Throws
/// Error if the folder cannot be read, and Cancelled. `only`: names of scenes; empty: all.
std::vector<FoundScene> find_scenes(Paper paper, const std::filesystem::path& folder,
                                    const std::filesystem::path& made,
                                    const std::vector<std::string>& only, CellStore& cells,
                                    Progress& progress);

}  // namespace voxdag
