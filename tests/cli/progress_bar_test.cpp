#include "cli/progress_bar.hpp"

#include <gtest/gtest.h>

namespace voxdag::cli {
namespace {

TEST(ProgressLine, HasRateAndTimeLeft) {
  EXPECT_EQ(progress_line("voxelize", 0.25, 5'000'000, 10),
            "voxelize   [######..................]  25%  500 k/s  0:30 left");
}

TEST(ProgressLine, DoesNotGuessFromNothing) {
  EXPECT_EQ(progress_line("read", 0, 0, 1), "read       [........................]   0%");
  EXPECT_EQ(progress_line("read", 7, 0, 0), "read       [########################] 100%");
}

}  // namespace
}  // namespace voxdag::cli
