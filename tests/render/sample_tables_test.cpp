#include "voxdag/render/sample_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace voxdag {
namespace {

constexpr int kCount = 64;

TEST(SampleTables, EverySquareSetHasOnePointInEachStripAndCell) {
  const SampleSets sets(kCount, 1);
  for (int set = 0; set < SampleTables::kSets; ++set) {
    std::set<int> columns, rows, cells;
    for (int i = 0; i < kCount; ++i) {
      const Point2f p = sets.square()[static_cast<std::size_t>(set * kCount + i)];
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      columns.insert(static_cast<int>(p.x * kCount));
      rows.insert(static_cast<int>(p.y * kCount));
      cells.insert(static_cast<int>(p.x * 8) * 8 + static_cast<int>(p.y * 8));
    }
    EXPECT_EQ(columns.size(), 64u);
    EXPECT_EQ(rows.size(), 64u);
    EXPECT_EQ(cells.size(), 64u);
  }
}

TEST(SampleTables, DiscsAreUniform) {
  const SampleSets sets(kCount, 1);
  double inner = 0, x = 0;
  for (const Point2f p : sets.disc()) {
    const float r2 = p.x * p.x + p.y * p.y;
    ASSERT_TRUE(r2 > 0 && r2 <= 1);
    inner += r2 < 0.25f ? 1 : 0;
    x += static_cast<double>(p.x);
  }
  const auto count = static_cast<double>(sets.disc().size());
  EXPECT_EQ(inner / count, 0.25);  // a quarter of the first dimension's strata
  EXPECT_NEAR(x / count, 0, 1e-3);
}

TEST(SampleTables, HemispheresFollowTheCosineAndLengthsTheFalloff) {
  const SampleSets sets(1, kCount);
  double cosine = 0, above[4] = {};
  for (const HemisphereSample& sample : sets.hemisphere()) {
    EXPECT_NEAR(dot(sample.direction, sample.direction), 1, 1e-6);
    EXPECT_GE(sample.direction.z, 0);
    cosine += static_cast<double>(sample.direction.z);
    for (int i = 0; i < 4; ++i) above[i] += sample.reach > static_cast<float>(i) / 4 ? 1 : 0;
  }
  const auto count = static_cast<double>(sets.hemisphere().size());
  EXPECT_NEAR(cosine / count, 2.0 / 3, 1e-3);  // for a density of cos / pi
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(above[i] / count, (1 - i / 4.0) * (1 - i / 4.0), 0.01) << i;
}

TEST(SampleTables, PixelsDiffer) {
  const SampleSets sets(1, kCount);
  const SampleTables tables = sets.view();
  std::set<std::tuple<int, float, float>> seen;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      for (int purpose = 0; purpose < 3; ++purpose) {
        const PixelSamples pixel = pixel_samples(tables, x, y, purpose);
        EXPECT_TRUE(pixel.set >= 0 && pixel.set < SampleTables::kSets);
        EXPECT_TRUE(pixel.shift.x >= 0 && pixel.shift.x < 1);
        seen.insert({pixel.set, pixel.rotation.x, pixel.rotation.y});
      }
  EXPECT_GT(seen.size(), 2600u);  // of 3072; a few of the 16384 values collide by chance
}

}  // namespace
}  // namespace voxdag
