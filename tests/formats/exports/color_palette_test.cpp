#include "voxdag/formats/exports/grids/color_palette.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace voxdag {
namespace {

TEST(ColorPalette, FewColorsStayAsTheyAre) {
  ColorCounter counter(3);
  for (const Value8 color : {Value8{9, 8, 7}, Value8{1, 2, 3}, Value8{9, 8, 7}, Value8{1, 2, 2}})
    counter.add(color);
  const ColorPalette palette = counter.palette();
  EXPECT_EQ(palette.colors(), (std::vector<Value8>{{1, 2, 2}, {1, 2, 3}, {9, 8, 7}}));
  EXPECT_EQ(palette.index_of({9, 8, 7}), 2);
}

TEST(ColorPalette, ClustersGetAColorEach) {
  std::mt19937 rng(3);
  const std::vector<Value8> centres{{20, 20, 20}, {200, 40, 60}, {40, 220, 80}, {60, 70, 240}};
  ColorCounter counter(4);
  std::vector<std::pair<Value8, std::size_t>> colors;
  for (int i = 0; i < 4000; ++i) {
    const std::size_t cluster = rng() % 4;
    Value8 color = centres[cluster];
    color.x = static_cast<std::uint8_t>(color.x + rng() % 9);
    color.y = static_cast<std::uint8_t>(color.y + rng() % 9);
    color.z = static_cast<std::uint8_t>(color.z + rng() % 9);
    counter.add(color);
    colors.emplace_back(color, cluster);
  }
  const ColorPalette palette = counter.palette();
  ASSERT_EQ(palette.colors().size(), 4u);
  std::vector<std::set<int>> indices(4);
  for (const auto& [color, cluster] : colors) {
    const std::uint8_t index = palette.index_of(color);
    indices[cluster].insert(index);
    const Value8 mean = palette.colors()[index];
    EXPECT_LE(std::abs(mean.x - color.x), 8);
    EXPECT_LE(std::abs(mean.y - color.y), 8);
    EXPECT_LE(std::abs(mean.z - color.z), 8);
  }
  for (const std::set<int>& of_cluster : indices) EXPECT_EQ(of_cluster.size(), 1u);
}

TEST(ColorPalette, DoesNotDependOnTheOrder) {
  std::mt19937 rng(4);
  std::vector<Value8> colors(5000);
  for (Value8& c : colors)
    c = {static_cast<std::uint8_t>(rng()), static_cast<std::uint8_t>(rng() % 64),
         static_cast<std::uint8_t>(rng() % 7)};
  ColorCounter forward(255), backward(255);
  for (const Value8 color : colors) forward.add(color);
  std::reverse(colors.begin(), colors.end());
  for (const Value8 color : colors) backward.add(color);
  EXPECT_EQ(forward.palette().colors(), backward.palette().colors());
  EXPECT_EQ(forward.palette().colors().size(), 255u);
}

}  // namespace
}  // namespace voxdag
