#pragma once
/// The scenes that the tests of exports write, and what they read back.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "support/brute_svdag.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/formats/exports/export_arrays.hpp"
#include "voxdag/formats/exports/export_ply.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"

namespace voxdag {

using VoxelKey = std::tuple<int, int, int>;

/// Random voxels, and their DAG in a grid that is not at the origin.
struct ExportedScene {
  explicit ExportedScene(int levels, int count = 300)
      : voxels(random_voxels(levels, count, 5)), dag(brute_svdag(levels, voxels)) {
    grid.levels = levels;
    grid.origin = {10, -20, 0.5};
    grid.voxel_size = 0.25;
    for (const Vec3i v : voxels) set.insert({v.x, v.y, v.z});
  }
  SvdagView view() const { return dag.view(); }
  bool has(int x, int y, int z) const { return set.contains({x, y, z}); }

  std::vector<Vec3i> voxels;
  Svdag dag;
  Grid grid;
  std::set<VoxelKey> set;
};

inline ExportOptions windowed(Vec3i lo, Vec3i hi) {
  ExportOptions options;
  options.window = Box3i{lo, hi};
  return options;
}

/// Returns the placement that was written beside an export.
inline nlohmann::json placement_of(const std::filesystem::path& path) {
  return nlohmann::json::parse(read_text(path.string() + ".json"));
}

}  // namespace voxdag
