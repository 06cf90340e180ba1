#include "voxdag/image/exr.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/read_pictures.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

ImageF pattern() {
  ImageF image(13, 7, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(i) * 0.37f - 20.0f;
  image.pixel(3, 2)[0] = std::numeric_limits<float>::infinity();
  return image;
}

const std::vector<std::string> kNames = {"N.X", "N.Y", "N.Z",
                                         "Z"};  // sorted, as OpenEXR returns them

TEST(Exr, ChannelsSurviveTheRoundTripBitForBit) {
  const TempDir dir;
  write_exr(dir / "a.exr", pattern(), kNames);
  const ExrImage back = read_exr(dir / "a.exr");
  EXPECT_EQ(back.channel_names, kNames);
  EXPECT_EQ(back.image, pattern());
}

TEST(Exr, ChannelsComeBackSortedWithTheirValues) {
  const TempDir dir;
  ImageF image(1, 1, 2);
  image.pixels = {1.0f, 2.0f};
  write_exr(dir / "a.exr", image, {"Z", "A"});
  const ExrImage back = read_exr(dir / "a.exr");
  EXPECT_EQ(back.channel_names, (std::vector<std::string>{"A", "Z"}));
  EXPECT_EQ(back.image.pixels, (std::vector<float>{2.0f, 1.0f}));
}

TEST(Exr, BadNamesAndEmptyImagesAreRefused) {
  const TempDir dir;
  EXPECT_THROW(write_exr(dir / "a.exr", pattern(), {"A", "B", "C"}), Error);
  EXPECT_THROW(write_exr(dir / "a.exr", pattern(), {"A", "B", "C", "A"}), Error);
  EXPECT_THROW(write_exr(dir / "a.exr", ImageF(), {}), Error);
  EXPECT_FALSE(std::filesystem::exists(dir / "a.exr"));
}

}  // namespace
}  // namespace voxdag
