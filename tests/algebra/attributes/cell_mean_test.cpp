#include "voxdag/algebra/attributes/cell_mean.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

constexpr ValueKinds kAll{true, true, 10};

TEST(CellMean, EqualValuesStayAsTheyAre) {
  CellMean mean(kAll);
  // Not a unit vector: as a lossy encoder may store it.
  const CellValues values{{12, 34, 56}, {129, 131, 200}, 7};
  for (const std::uint64_t weight : {3u, 1u, 1000u}) mean.add(values, weight);
  EXPECT_EQ(mean.result(), values);
}

TEST(CellMean, ColoursAreAveragedInLinearLight) {
  CellMean mean(kAll);
  mean.add({{255, 0, 10}, {128, 255, 128}, 0}, 1);
  mean.add({{0, 255, 10}, {128, 255, 128}, 0}, 1);
  EXPECT_EQ(mean.result().color, (Value8{188, 188, 10}));  // half the light is code 188
  mean.add({{0, 255, 10}, {128, 255, 128}, 0}, 2);
  EXPECT_EQ(mean.result().color, (Value8{137, 225, 10}));  // a quarter is 137, three are 225
}

TEST(CellMean, NormalsGiveTheDirectionOfTheirSum) {
  CellMean mean(kAll);
  mean.add({{}, pack_normal({1, 0, 0}), 0}, 1);
  mean.add({{}, pack_normal({0, 1, 0}), 0}, 1);
  EXPECT_EQ(mean.result().normal, pack_normal({0.70710678f, 0.70710678f, 0}));
}

TEST(CellMean, OfOppositeNormalsTheHeaviestCounts) {
  CellMean mean(kAll);
  mean.add({{}, pack_normal({1, 0, 0}), 0}, 5);
  mean.add({{}, pack_normal({-1, 0, 0}), 0}, 5);
  EXPECT_EQ(mean.result().normal, pack_normal({1, 0, 0}));
  mean.add({{}, pack_normal({-1, 0, 0}), 0}, 6);
  EXPECT_EQ(mean.result().normal, pack_normal({-1, 0, 0}));
}

TEST(CellMean, TheHeaviestMaterialCountsThenTheSmallestId) {
  CellMean mean(kAll);
  mean.add({{}, {}, 6}, 3);
  mean.add({{}, {}, 9}, 2);
  EXPECT_EQ(mean.result().material, 6);
  mean.add({{}, {}, 9}, 2);
  EXPECT_EQ(mean.result().material, 9);
  mean.add({{}, {}, 2}, 4);
  EXPECT_EQ(mean.result().material, 2);
}

}  // namespace
}  // namespace voxdag
