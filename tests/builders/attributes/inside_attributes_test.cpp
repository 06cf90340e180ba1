#include "voxdag/builders/attributes/inside_attributes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"

namespace voxdag {
namespace {

constexpr int kLevels = 4;

/// A hollow ball with a colour and a material for each cell.
struct Shell {
  std::vector<Vec3i> shell = voxels_where(kLevels, [](Vec3i v) { return depth(v) > 36; });
  std::vector<Vec3i> ball = voxels_where(kLevels, [](Vec3i v) { return depth(v) >= 0; });
  Svdag surface, solid;
  DagAttributes attributes;

  explicit Shell(int finest) {
    surface = brute_svdag(kLevels, shell);
    solid = brute_svdag(kLevels, ball);
    attributes.index = build_cell_index(surface.view(), finest);
    ValueEncoder colors(attributes.index.cells, make_value_metric(kColorWeights, 0), nullptr);
    MaterialEncoder materials(1000);
    for (std::uint64_t number = 0; number < attributes.index.cells; ++number) {
      const Value8 color = color_of(number);
      colors.add(number, {&color, 1});
      materials.add(static_cast<std::uint32_t>(number * 7 % 1000), 1);
    }
    attributes.colors = colors.finish();
    attributes.materials = materials.finish();
  }
  /// Returns the squared distance from the centre of the grid, in half voxels; -1 beyond the ball.
  static int depth(Vec3i v) {
    int sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += (2 * v[axis] - 15) * (2 * v[axis] - 15);
    return sum / 4 <= 49 ? sum / 4 : -1;
  }
  static Value8 color_of(std::uint64_t number) {
    return {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8),
            static_cast<std::uint8_t>(number * 31)};
  }
  /// Returns the number of the surface's cell whose values a cell of the solid takes.
  std::uint64_t expected_number(Vec3i cell, int level, int finest) const {
    std::uint64_t number = 0;
    if (find_cell_number(surface.view(), attributes.index.view(), cell, level, number))
      return number;
    double nearest = HUGE_VAL;
    Vec3i best{};
    const double side = std::ldexp(1.0, finest - level);
    std::vector<Vec3i> cells;
    for (const Vec3i v : shell)
      cells.push_back(
          {v.x >> (kLevels - finest), v.y >> (kLevels - finest), v.z >> (kLevels - finest)});
    for (const Vec3i v : cells) {
      double distance2 = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double at = (cell[axis] + 0.5) * side;
        const double d = std::max({v[axis] - at, at - v[axis] - 1, 0.0});
        distance2 += d * d;
      }
      if (distance2 > nearest || (distance2 == nearest && !is_before(v, best))) continue;
      nearest = distance2;
      best = v;
    }
    EXPECT_TRUE(find_cell_number(surface.view(), attributes.index.view(), best, finest, number));
    return number;
  }
};

TEST(InsideAttributes, EachCellHasTheValueOfTheNearestSurface) {
  for (const int finest : {2, 3, 4}) {
    const Shell scene(finest);
    AttributeOptions options;
    options.color_bound = 0;
    const std::optional<Value8> green = Value8{0, 255, 0};
    const ColoredDagView surface{scene.surface.view(), scene.attributes.view()};
    const DagAttributes of = inside_attributes(surface, scene.solid.view(), options, {});
    const DagAttributes painted = inside_attributes(surface, scene.solid.view(), options, green);
    const CellIndex index = build_cell_index(scene.solid.view(), finest);
    EXPECT_EQ(of.index, index);
    int inside = 0;
    for (int level = 0; level <= finest; ++level)
      for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * level; ++code) {
        const Vec3i cell = morton_decode(code);
        std::uint64_t number = 0, own = 0;
        if (!find_cell_number(scene.solid.view(), index.view(), cell, level, number)) continue;
        const bool is_inside = !find_cell_number(scene.surface.view(),
                                                 scene.attributes.index.view(), cell, level, own);
        inside += is_inside ? 1 : 0;
        const std::uint64_t expected = scene.expected_number(cell, level, finest);
        ASSERT_EQ(read_value(of.colors.view(), number), Shell::color_of(expected)) << level;
        ASSERT_EQ(read_material(of.materials.view(), number), expected * 7 % 1000);
        ASSERT_EQ(read_value(painted.colors.view(), number),
                  is_inside ? *green : Shell::color_of(expected));
      }
    EXPECT_GT(inside, finest == 4 ? 500 : 1);
  }
}

TEST(InsideAttributes, ASolidWithoutSurfaceInTheGridIsRefused) {
  const Shell scene(kLevels);
  Svdag none;
  none.levels = kLevels;
  DagAttributes empty;
  EXPECT_NE(error_of([&] {
              inside_attributes({none.view(), empty.view()}, scene.solid.view(), {}, {});
            }),
            "");
}

}  // namespace
}  // namespace voxdag
