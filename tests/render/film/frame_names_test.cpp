#include "voxdag/render/film/frame_names.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(FrameNames, TakeOneNumber) {
  EXPECT_TRUE(is_frame_pattern("a_%04d.png"));
  EXPECT_TRUE(is_frame_pattern("%d.png"));
  EXPECT_EQ(frame_name("a_%04d.png", 12), "a_0012.png");
  EXPECT_EQ(frame_name("%d.png", 7), "7.png");
  EXPECT_EQ(frame_name("%02d", 12345), "12345");
  for (const char* other : {"a.png", "%s.png", "%4d.png", "%d_%d.png", "100%.png", "%00d.png"}) {
    EXPECT_FALSE(is_frame_pattern(other)) << other;
    EXPECT_EQ(frame_name(other, 1), other);
  }
}

TEST(FrameNames, FaultsOfPatternsAreNamed) {
  EXPECT_EQ(frame_pattern_fault("a%04d.png"), "");
  for (const char* none : {"a.png", "a%s.png", "a%4d.png"})
    EXPECT_NE(frame_pattern_fault(none).find("no placeholder"), std::string::npos) << none;
  EXPECT_NE(frame_pattern_fault("%d%d.png").find("2 placeholders"), std::string::npos);
  EXPECT_NE(frame_pattern_fault("100%_%d.png").find("a % that is not a placeholder"),
            std::string::npos);
}

}  // namespace
}  // namespace voxdag
