#pragma once
/// The metadata that all scene files have in common, DAGs and ESVOs.
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/view.hpp"

namespace voxdag {

/// The mesh that the voxels come from.
struct VdagSource {
  std::string name;  ///< File name without folders; UTF-8.
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  friend bool operator==(const VdagSource&, const VdagSource&) = default;
};

/// The up axis, the unit and the home view of a scene, as far as they are known.
struct Presentation {
  std::optional<char> up;        ///< The axis that points up: 'x', 'y' or 'z'.
  std::string unit;              ///< Of the coordinates: mm, cm, m, in or ft; empty: not known.
  std::optional<HomeView> home;  ///< Its up vector is that axis.
  bool cubes = false;            ///< Whether voxels are cubes, not samples of smooth surfaces.
  bool is_up_guessed = false;  ///< Whether `up` was detected in the voxels, not told by the input.

  /// Returns the unit vector that points up.
  std::optional<Vec3d> up_vector() const {
    if (!up) return std::nullopt;
    return Vec3d{*up == 'x' ? 1.0 : 0, *up == 'y' ? 1.0 : 0, *up == 'z' ? 1.0 : 0};
  }
  friend bool operator==(const Presentation&, const Presentation&) = default;
};

/// The metadata that DAGs and ESVOs share. It must depend on the input alone, so that equal inputs
/// make equal files: no times, no folders, no thread counts, and not the choice between two
/// equivalent methods.
struct SceneMetadata {
  Grid grid;
  VdagSource source;
  std::string program;                       ///< The program that wrote the file: "voxdag 0.2.0".
  std::map<std::string, std::string> build;  ///< Settings that shape the result: "cover": "exact".
  Presentation presentation;
  friend bool operator==(const SceneMetadata&, const SceneMetadata&) = default;
};

}  // namespace voxdag
