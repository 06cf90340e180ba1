#include "cli/parse.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace voxdag::cli {
namespace {

/// Returns the reason with which `parse` refuses `text`, or "" if it accepts the text.
template <class T>
std::string refusal(T (*parse)(const std::string&), const std::string& text) {
  try {
    parse(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Parse, LevelsOfEveryPowerOfTwo) {
  for (int levels = 2; levels <= 20; ++levels)
    EXPECT_EQ(parse_levels(std::to_string(1 << levels)), levels);
  EXPECT_EQ(parse_levels("64K"), 16);
}

TEST(Parse, AResolutionThatIsNoPowerOfTwoNamesItsNeighbours) {
  EXPECT_NE(refusal(parse_levels, "1000").find("nearest are 512 and 1024"), std::string::npos);
  EXPECT_NE(refusal(parse_levels, "3").find("nearest is 4"), std::string::npos);
  EXPECT_NE(refusal(parse_levels, "2097152").find("nearest is 1048576"), std::string::npos);
  for (const char* text : {"", "K", "8192x", "-8", "8.0", "0", "99999999999999999999", "4000000K"})
    EXPECT_NE(refusal(parse_levels, text), "") << text;
}

TEST(Parse, MemoryInBinaryUnits) {
  EXPECT_EQ(parse_memory("1000000"), 1000000u);
  for (const char* text : {"512M", "512MB", "512MiB", "512m", "0.5G"})
    EXPECT_EQ(parse_memory(text), 512u << 20) << text;
  EXPECT_EQ(parse_memory("16GiB"), std::uint64_t{16} << 30);
  for (const char* text : {"", "M", "-1M", "12X", "1MM", "0", "1e99", "inf", "99999999T"})
    EXPECT_NE(refusal(parse_memory, text), "") << text;
}

TEST(Parse, ThreeFiniteNumbers) {
  EXPECT_EQ(parse_vec3("1.5,-2,3e-1"), (Vec3d{1.5, -2, 0.3}));
  for (const char* text :
       {"", "1", "1,2", "1,2,3,4", "1,,3", "1,2,x", "1,2,nan", "inf,0,0", "1, 2,3"})
    EXPECT_NE(refusal(parse_vec3, text), "") << text;
}

TEST(Parse, TheCornersOfABoxAreInOrder) {
  EXPECT_EQ(parse_box("-1,-1,-1,1,2,3"), (Box3d{{-1, -1, -1}, {1, 2, 3}}));
  EXPECT_NE(refusal(parse_box, "0,0,0,1,0,1"), "");
  EXPECT_EQ(parse_window("0,0,0,1,2,3"), (Box3i{{0, 0, 0}, {1, 2, 3}}));
  EXPECT_NE(refusal(parse_window, "0,0,0,1,2,3.5"), "");
}

TEST(Parse, ImageSize) {
  EXPECT_EQ(parse_image_size("1920x1080").width, 1920);
  EXPECT_EQ(parse_image_size("1920x1080").height, 1080);
  for (const char* text : {"", "1920", "0x5", "5x-1", "x", "99999x5", "5x5x5"})
    EXPECT_NE(refusal(parse_image_size, text), "") << text;
}

}  // namespace
}  // namespace voxdag::cli
