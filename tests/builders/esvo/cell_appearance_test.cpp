#include "voxdag/builders/esvo/build/cell_appearance.hpp"

#include <gtest/gtest.h>

#include "voxdag/builders/pieces/piece_stack.hpp"

namespace voxdag {
namespace {

/// A cell of 8 voxels a side with `count` triangles. All corners have the same colour.
struct ColoredCell {
  Mesh mesh;
  Appearance appearance;
  PieceStack pieces;

  explicit ColoredCell(int count) {
    appearance.materials.resize(1);
    for (int i = 0; i < count; ++i) {
      const auto z = static_cast<float>(i) * 0.1f;
      for (const Vec3f p : {Vec3f{1, 1, z}, Vec3f{6, 1, z}, Vec3f{1, 6, z}}) {
        mesh.vertices.push_back(p);
        appearance.colors.push_back({30000, 20000, 10000, 65535});
      }
      const auto first = static_cast<std::uint32_t>(3 * i);
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const QuantizedMesh quantized(mesh, {3, {0, 0, 0}, 1.0, kSubvoxels});
    pieces.start(3, {}, mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
      pieces.add(SurfaceTriangle::make(quantized.triangle(i), {}, i, 0), i);
  }
};

TEST(CellAppearance, PiecesOfOneColorAreUniform) {
  for (const int count : {1, 24, 25, 200}) {
    const ColoredCell cell(count);
    const SurfaceShading shading(cell.mesh, cell.appearance);
    const EsvoSettings settings;
    const CellAppearance appearance(settings, &shading);
    EXPECT_TRUE(appearance.sum_if_uniform(cell.pieces.view(cell.pieces.root())).has_value())
        << count;
  }
}

TEST(CellAppearance, OnePieceOfAnotherColorIsFoundAmongMany) {
  for (const std::size_t count : {2, 24, 25, 200}) {
    ColoredCell cell(static_cast<int>(count));
    for (std::size_t k = 0; k < 3; ++k)
      cell.appearance.colors[3 * (count - 1) + k] = {60000, 50000, 60000, 65535};
    const SurfaceShading shading(cell.mesh, cell.appearance);
    const EsvoSettings settings;
    const CellAppearance appearance(settings, &shading);
    EXPECT_FALSE(appearance.sum_if_uniform(cell.pieces.view(cell.pieces.root())).has_value())
        << count;
  }
}

}  // namespace
}  // namespace voxdag
