#pragma once
/// The metadata that all scene files have in common, DAGs and ESVOs.
#include <cstdint>
#include <map>
#include <string>

#include "voxdag/core/grid.hpp"

namespace voxdag {

/// The mesh that the voxels come from.
struct VdagSource {
  std::string name;  ///< File name without folders; UTF-8.
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  friend bool operator==(const VdagSource&, const VdagSource&) = default;
};

/// The metadata that DAGs and ESVOs share. It must depend on the input alone, so that equal inputs
/// make equal files: no times, no folders, no thread counts, and not the choice between two
/// equivalent methods.
struct SceneMetadata {
  Grid grid;
  VdagSource source;
  std::string program;                       ///< The program that wrote the file: "voxdag 0.1.0".
  std::map<std::string, std::string> build;  ///< Settings that shape the result: "cover": "exact".
  friend bool operator==(const SceneMetadata&, const SceneMetadata&) = default;
};

}  // namespace voxdag
