#include "voxdag/cpu/post_filter.hpp"

#include <gtest/gtest.h>

#include <random>

namespace voxdag {
namespace {

TEST(FilterPicture, EqualsTheFilterAtEveryPixel) {
  std::mt19937 random(1);
  constexpr int kWidth = 53, kHeight = 31;
  std::vector<Vec3f> color(kWidth * kHeight);
  std::vector<std::uint8_t> size(color.size());
  for (std::size_t i = 0; i < color.size(); ++i) {
    const auto part = [&random] { return static_cast<float>(random() % 256) / 255.0f; };
    color[i] = {part(), part(), part()};
    size[i] = static_cast<std::uint8_t>(random() % 3 * 60);
  }
  const FilterInput input{color.data(), size.data(), kWidth, kHeight};
  const std::vector<Vec3f> filtered = filter_picture(input);
  ASSERT_EQ(filtered.size(), color.size());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      ASSERT_EQ(filtered[static_cast<std::size_t>(y * kWidth + x)],
                filtered_color(input, filter_table().data(), x, y));
}

TEST(FilterPicture, APictureWithoutPixelsHasNone) { EXPECT_TRUE(filter_picture({}).empty()); }

}  // namespace
}  // namespace voxdag
