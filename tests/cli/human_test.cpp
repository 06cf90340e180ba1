#include "cli/human.hpp"

#include <gtest/gtest.h>

#include "cli/progress_bar.hpp"

namespace voxdag {
namespace {

TEST(Human, Numbers) {
  EXPECT_EQ(with_commas(0), "0");
  EXPECT_EQ(with_commas(999), "999");
  EXPECT_EQ(with_commas(1234567), "1,234,567");
  EXPECT_EQ(human_bytes(0), "0 B");
  EXPECT_EQ(human_bytes(1023), "1023 B");
  EXPECT_EQ(human_bytes(1536), "1.50 KiB");
  EXPECT_EQ(human_bytes(std::uint64_t{3} << 30), "3.00 GiB");
  EXPECT_EQ(human_count(999), "999");
  EXPECT_EQ(human_count(63.9e6), "63.9 M");
  EXPECT_EQ(human_ratio(33.44), "33.4");
  EXPECT_EQ(human_ratio(1234), "1,234");
}

TEST(Human, Times) {
  EXPECT_EQ(human_seconds(0.354), "0.35 s");
  EXPECT_EQ(human_seconds(125), "2 min 05 s");
  EXPECT_EQ(human_clock(7), "0:07");
  EXPECT_EQ(human_clock(3723), "1:02:03");
}

TEST(ProgressLine, HasRateAndTimeLeft) {
  EXPECT_EQ(progress_line("voxelize", 0.25, 5'000'000, 10),
            "voxelize   [######..................]  25%  500 k/s  0:30 left");
}

TEST(ProgressLine, DoesNotGuessFromNothing) {
  EXPECT_EQ(progress_line("read", 0, 0, 1), "read       [........................]   0%");
  EXPECT_EQ(progress_line("read", 7, 0, 0), "read       [########################] 100%");
}

}  // namespace
}  // namespace voxdag
