#pragma once
/// A scene with colours, normals and materials for the tests of exports.
#include <map>
#include <set>
#include <utility>

#include "exported_scene.hpp"
#include "support/number_colors.hpp"

namespace voxdag {

/// A scene whose cells have attributes that tell their numbers.
struct ColoredScene : ExportedScene {
  explicit ColoredScene(int finest_level)
      : ExportedScene(6, 900), finest(finest_level), attributes(dag.view(), finest_level) {
    // A parent is before its children, and children are in Morton order.
    std::set<std::pair<std::uint64_t, int>> cells;
    for (const Vec3i v : voxels)
      for (int level = 0; level <= finest; ++level)
        cells.insert({first_code(morton_encode(v), level), level});
    for (const auto& cell : cells) numbers.emplace(cell, numbers.size());
    options.look = attributes.view();
  }
  /// Returns the code of the first voxel in the cell of `level` that holds the voxel.
  std::uint64_t first_code(std::uint64_t code, int level) const {
    const int shift = 3 * (grid.levels - level);
    return code >> shift << shift;
  }
  /// Returns the number of the voxel, or of the cell of the finest level that holds it.
  std::uint64_t number(Vec3i voxel) const {
    return numbers.at({first_code(morton_encode(voxel), finest), finest});
  }
  Value8 value(Vec3i voxel) const { return color_of_number(number(voxel)); }

  int finest;
  NumberColors attributes;
  std::map<std::pair<std::uint64_t, int>, std::uint64_t> numbers;
  ExportOptions options;
};

}  // namespace voxdag
