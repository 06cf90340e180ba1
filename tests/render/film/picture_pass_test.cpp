#include "voxdag/render/film/picture_pass.hpp"

#include <gtest/gtest.h>

#include <set>

namespace voxdag {
namespace {

TEST(PicturePass, KindsHaveDistinctNamesAndAreFoundByThem) {
  std::set<std::string_view> names;
  for (const PictureKind& kind : picture_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(find_picture_kind(kind.name), &kind);
  }
  EXPECT_EQ(find_picture_kind("colour"), nullptr);
}

TEST(PicturePass, EveryKindHasAChannelForEachOfItsValues) {
  RenderedImage image;
  image.width = 2;
  image.height = 1;
  image.rgb = image.radiance = image.normal = image.albedo = {{1, 0, 0}, {0, 1, 0}};
  image.depth = image.occlusion = image.shadow = image.steps = {1, 0.5f};
  image.cells = {{}, {{4, 5, 6}, 3}};
  image.material = {-1, 7};
  for (const PictureKind& kind : picture_kinds()) {
    const ImageF values = kind.values(image);
    EXPECT_EQ(values.pixels.size(), 2 * kind.channels.size()) << kind.name;
    EXPECT_EQ(kind.shown(image).pixels.size(), 6u) << kind.name;
  }
}

TEST(PicturePass, Steps64ShowsSixtyFourStepsAsWhite) {
  RenderedImage image;
  image.width = 3;
  image.height = 1;
  image.steps = {0, 32, 200};
  const ImageRgb8 shown = find_picture_kind("steps64")->shown(image);
  EXPECT_EQ(shown.pixels, (std::vector<std::uint8_t>{0, 0, 0, 128, 128, 128, 255, 255, 255}));
}

TEST(PicturePass, OnlyPngAndExrArePictures) {
  EXPECT_TRUE(is_picture_path("a.png"));
  EXPECT_TRUE(is_picture_path("b.c.exr"));
  for (const char* other : {"a.jpg", "a", ".png", "a.PNG"}) EXPECT_FALSE(is_picture_path(other));
}

}  // namespace
}  // namespace voxdag
