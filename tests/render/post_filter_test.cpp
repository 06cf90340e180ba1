#include "voxdag/render/post_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace voxdag {
namespace {

struct Picture {
  int width, height;
  std::vector<Vec3f> color;
  std::vector<std::uint8_t> size;

  Picture(int w, int h, float cell_pixels)
      : width(w),
        height(h),
        color(static_cast<std::size_t>(w * h)),
        size(color.size(), pack_cell_pixels(cell_pixels)) {}

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * width + x); }
  FilterInput input() const { return {color.data(), size.data(), width, height}; }
  Vec3f naive(int x, int y) const {
    FilterInput with = input();
    with.shrinks = false;
    return filtered_color(with, filter_table().data(), x, y);
  }
  Vec3f filtered(int x, int y) const {
    return filtered_color(input(), filter_table().data(), x, y);
  }
};

/// Computes Figure 11, line by line, in double precision; the naive filter without line 6.
Vec3d figure_11(const Picture& picture, int x, int y, bool shrinks = true) {
  const auto size = [&](int px, int py) {
    return std::exp2(picture.size[picture.at(px, py)] / 32.0);
  };
  double r = size(x, y);
  if (r <= 1) return Vec3d(picture.color[picture.at(x, y)]);
  Vec3d rgb{};
  double w_sum = 0;
  for (const FilterSample& s : filter_table()) {
    const int px = x + s.x, py = y + s.y;
    if (px < 0 || py < 0 || px >= picture.width || py >= picture.height) continue;
    const Vec3d c = Vec3d(picture.color[picture.at(px, py)]);
    if (shrinks) r = std::min(r, size(px, py));
    const double distance = std::hypot(s.x, s.y);
    if (distance > r) break;
    const double w = static_cast<double>(s.weight) * std::min(r - distance, 1.0);
    rgb = rgb + c * w;
    w_sum += w;
  }
  return rgb * (1 / w_sum);
}

TEST(CellPixels, EveryCodeIsADistinctSize) {
  for (int code = 0; code < 256; ++code)
    EXPECT_EQ(pack_cell_pixels(unpack_cell_pixels(static_cast<std::uint8_t>(code))), code);
  EXPECT_EQ(unpack_cell_pixels(0), 1.0f);
  EXPECT_NEAR(unpack_cell_pixels(160), 32.0f, 1e-5f);
  EXPECT_NEAR(unpack_cell_pixels(255), 250.5f, 0.1f);
}

TEST(CellPixels, SizesOutOfRangeAreClamped) {
  EXPECT_EQ(pack_cell_pixels(0.0f), 0);
  EXPECT_EQ(pack_cell_pixels(-3.0f), 0);
  EXPECT_EQ(pack_cell_pixels(NAN), 0);
  EXPECT_EQ(pack_cell_pixels(1.0f), 0);
  EXPECT_EQ(pack_cell_pixels(1e9f), 255);
  EXPECT_EQ(pack_cell_pixels(INFINITY), 255);
}

TEST(FilterTable, IsSortedFromTheCentreToTheRim) {
  const FilterTable& table = filter_table();
  EXPECT_EQ(table[0].x, 0);
  EXPECT_EQ(table[0].y, 0);
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_FLOAT_EQ(table[i].distance,
                    std::hypot(static_cast<float>(table[i].x), static_cast<float>(table[i].y)));
    EXPECT_LE(table[i].distance, kFilterRadius);
    EXPECT_GE(table[i].distance, table[i > 0 ? i - 1 : 0].distance);
  }
}

TEST(FilterTable, DensityFallsAsTheSquareRootOfTheDistance) {
  // The number of samples within a distance must be proportional to distance^(3/2).
  for (const float r : {4.0f, 8.0f, 12.0f, 16.0f, 20.0f, 24.0f}) {
    const auto within = std::count_if(filter_table().begin(), filter_table().end(),
                                      [r](const FilterSample& s) { return s.distance <= r; });
    EXPECT_NEAR(static_cast<float>(within), 96 * std::pow(r / 24, 1.5f), 3.0f) << r;
  }
}

TEST(FilterTable, WeightsAreTheAreaOfTheDisc) {
  float sum = 0;
  for (const FilterSample& s : filter_table()) {
    EXPECT_GT(s.weight, 0.0f);
    sum += s.weight;
  }
  EXPECT_NEAR(sum, 3.14159265f * kFilterRadius * kFilterRadius, 4.0f);
}

TEST(FilterTable, SamplesDoNotClump) {
  const FilterTable& table = filter_table();
  for (std::size_t i = 0; i < table.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const float apart = std::hypot(static_cast<float>(table[i].x - table[k].x),
                                     static_cast<float>(table[i].y - table[k].y));
      // A sample's share of the disc is a square of about this side.
      const float side = std::sqrt(5.1f * std::sqrt(std::max(table[i].distance, 0.5f)));
      EXPECT_GT(apart, 0.6f * side) << table[i].x << "," << table[i].y;
    }
}

/// Returns blocks of voxels of many sizes, with random colours.
Picture random_blocks() {
  std::mt19937 random(1);
  Picture picture(70, 50, 1);
  for (std::size_t i = 0; i < picture.color.size(); ++i) {
    const auto part = [&random] { return static_cast<float>(random() % 1000) / 100.0f; };
    picture.color[i] = {part(), part(), part()};
    const std::size_t block = (i % 70) / 18 + (i / 70) / 14 * 4;
    picture.size[i] = static_cast<std::uint8_t>(block * 37 % 200);
  }
  return picture;
}

TEST(PostFilter, IsFigure11) {
  const Picture picture = random_blocks();
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const Vec3d expected = figure_11(picture, x, y);
      const Vec3f filtered = picture.filtered(x, y);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(static_cast<double>(filtered[c]), expected[c], 1e-4) << x << "," << y;
    }
}

TEST(PostFilter, TheNaiveFilterKeepsTheRadiusOfThePixelsVoxel) {
  const Picture picture = random_blocks();
  int differ = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const Vec3d expected = figure_11(picture, x, y, false);
      const Vec3f filtered = picture.naive(x, y);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(static_cast<double>(filtered[c]), expected[c], 1e-4) << x << "," << y;
      differ += filtered == picture.filtered(x, y) ? 0 : 1;
    }
  EXPECT_GT(differ, picture.width * picture.height / 4);
}

TEST(PostFilter, AConstantPictureStays) {
  for (const float size : {1.0f, 2.0f, 7.5f, 24.0f, 200.0f}) {
    Picture picture(40, 30, size);
    std::fill(picture.color.begin(), picture.color.end(), Vec3f{0.3f, 2.0f, 7.0f});
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) {
        const Vec3f filtered = picture.filtered(x, y);
        ASSERT_NEAR(filtered.x, 0.3f, 1e-6f);
        ASSERT_NEAR(filtered.z, 7.0f, 1e-5f);
      }
  }
}

TEST(PostFilter, LightIsKept) {
  // All light of one pixel is distributed over the pixels around it.
  for (const float size : {2.5f, 6.0f, 13.0f, 24.0f}) {
    Picture picture(101, 101, size);
    picture.color[picture.at(50, 50)] = {1, 1, 1};
    double sum = 0;
    for (int y = 0; y < 101; ++y)
      for (int x = 0; x < 101; ++x) sum += static_cast<double>(picture.filtered(x, y).x);
    EXPECT_NEAR(sum, 1.0, 1e-5) << size;
  }
}

TEST(PostFilter, CellsOfAPixelStaySharp) {
  Picture picture(30, 30, 1);
  for (std::size_t i = 0; i < picture.color.size(); i += 2) picture.color[i] = {1, 1, 1};
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) EXPECT_EQ(picture.filtered(x, y), picture.color[picture.at(x, y)]);
}

TEST(PostFilter, TheBackgroundNeitherBlursNorBleeds) {
  // Black cells of 20 pixels next to a bright background on the right.
  Picture picture(80, 40, 20);
  for (int y = 0; y < 40; ++y)
    for (int x = 40; x < 80; ++x) {
      picture.color[picture.at(x, y)] = {100, 100, 100};
      picture.size[picture.at(x, y)] = 0;
    }
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 80; ++x) EXPECT_EQ(picture.filtered(x, y).x, x < 40 ? 0.0f : 100.0f);
}

TEST(PostFilter, RegionsOfDifferentSizesMeetWithoutASeam) {
  // An edge of light across the border of cells of 16 pixels and of 4.
  Picture picture(80, 60, 16);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) {
      if (x >= 40) picture.size[picture.at(x, y)] = pack_cell_pixels(4);
      if (y >= 30) picture.color[picture.at(x, y)] = {1, 1, 1};
    }
  const auto step = [&picture](int x, auto filter) {
    float most = 0;
    for (int y = 0; y < 60; ++y)
      most = std::max(most, std::fabs((picture.*filter)(x + 1, y).x - (picture.*filter)(x, y).x));
    return most;
  };
  for (int x = 10; x < 70; ++x) EXPECT_LT(step(x, &Picture::filtered), 0.15f) << x;
  EXPECT_GT(step(39, &Picture::naive), 0.25f) << "the naive filter has the seam of Figure 10";
}

TEST(PostFilter, BlocksOfNoiseBecomeSmooth) {
  std::mt19937 random(2);
  Picture picture(96, 96, 8);
  std::vector<float> block(144);
  for (float& value : block) value = static_cast<float>(random() % 2);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) {
      const float value = block[static_cast<std::size_t>(y / 8 * 12 + x / 8)];
      picture.color[picture.at(x, y)] = {value, value, value};
    }
  for (int y = 16; y < 80; ++y)
    for (int x = 16; x < 79; ++x)
      EXPECT_LT(std::fabs(picture.filtered(x + 1, y).x - picture.filtered(x, y).x), 0.35f);
}

/// A checkerboard of voxels of 24 pixels on a plane that tilts away from the viewer.
struct GuidedPicture : Picture {
  std::vector<float> depth, occlusion, shadow;
  std::vector<Vec3f> normal;
  Camera camera = make_camera({{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40}, 64, 64);

  GuidedPicture()
      : Picture(64, 64, 24),
        depth(color.size()),
        occlusion(color.size(), 0.5f),
        shadow(color.size(), 1),
        normal(color.size(), normalized(Vec3f{0, 0.8f, 0.6f})) {
    const auto n = static_cast<Vec3d>(normal[0]);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double toward = dot(n, camera.direction(x + 0.5, y + 0.5));
        depth[at(x, y)] = static_cast<float>(dot(n, Vec3d{0, 0, -5}) / toward);
        color[at(x, y)] = Vec3f{1, 1, 1} * static_cast<float>((x + y) % 2);
      }
  }
  Vec3f guided(int x, int y) const {
    FilterInput with = input();
    with.guides = {depth.data(), normal.data(), occlusion.data(), shadow.data(), camera};
    return filtered_color(with, filter_table().data(), x, y);
  }
};

TEST(FilterInputOf, EachKindSetsItsRules) {
  GuidedPicture picture;
  const ImageBuffers image{picture.color.data(),     picture.depth.data(),  picture.normal.data(),
                           picture.occlusion.data(), picture.shadow.data(), nullptr,
                           picture.size.data()};
  const auto input = [&](FilterKind kind) { return filter_input(image, picture.camera, kind); };
  EXPECT_EQ(input(FilterKind::kGuided).guides.depth, picture.depth.data());
  EXPECT_EQ(input(FilterKind::kPlain).guides.depth, nullptr);
  EXPECT_EQ(input(FilterKind::kNaive).guides.depth, nullptr);
  EXPECT_TRUE(input(FilterKind::kGuided).shrinks);
  EXPECT_TRUE(input(FilterKind::kPlain).shrinks);
  EXPECT_FALSE(input(FilterKind::kNaive).shrinks);
}

TEST(FilteredColor, OnePlaneInOneLightIsMixedAsWithoutGuides) {
  const GuidedPicture picture;
  for (const int x : {5, 31, 60})
    for (const int y : {3, 32, 59}) EXPECT_EQ(picture.guided(x, y), picture.filtered(x, y));
}

TEST(FilteredColor, OtherSurfacesAndOtherLightAreLeftOut) {
  using Change = void (*)(GuidedPicture&, std::size_t);
  for (const Change change :
       {Change([](GuidedPicture&p, std::size_t i) { p.depth[i] *= 0.8f; }),
        Change([](GuidedPicture&p, std::size_t i) { p.depth[i] = HUGE_VALF; }),
        Change([](GuidedPicture&p, std::size_t i) {
          p.normal[i] = {0, 0, 1};
        }),
        Change([](GuidedPicture&p, std::size_t i) { p.normal[i] = {}; }),
        Change([](GuidedPicture&p, std::size_t i) { p.shadow[i] = 0.5f; }),
        Change([](GuidedPicture&p, std::size_t i) { p.occlusion[i] = 0.1f; })}) {
    GuidedPicture picture;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 32; x < picture.width; ++x) {
        change(picture, picture.at(x, y));
        picture.color[picture.at(x, y)] = {7, 7, 7};
      }
    EXPECT_GT(picture.filtered(30, 30).x, 2) << "without guides they are mixed";
    EXPECT_LT(picture.guided(30, 30).x, 1);
    EXPECT_GT(picture.guided(30, 30).x, 0.2f) << "its own side is mixed";
  }
}

TEST(FilteredColor, APixelWithoutSimilarNeighboursIsMixedWithAll) {
  GuidedPicture picture;
  picture.occlusion[picture.at(30, 30)] = 0;
  picture.color[picture.at(30, 30)] = {};
  EXPECT_EQ(picture.guided(30, 30), picture.filtered(30, 30));
  for (int x = 25; x < 36; ++x) picture.occlusion[picture.at(x, 30)] = 0;
  EXPECT_NE(picture.guided(30, 30), picture.filtered(30, 30)) << "a line is none";
}

}  // namespace
}  // namespace voxdag
