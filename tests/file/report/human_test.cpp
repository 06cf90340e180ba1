#include "voxdag/file/report/human.hpp"

#include <gtest/gtest.h>

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
  EXPECT_EQ(human_duration(40), "40 s");
  EXPECT_EQ(human_duration(59.9), "1 min");
  EXPECT_EQ(human_duration(7199), "2 h 00 min");
  EXPECT_EQ(human_duration(1.2e9), "13,889 days");
  EXPECT_EQ(human_clock(7), "0:07");
  EXPECT_EQ(human_clock(3723), "1:02:03");
}

}  // namespace
}  // namespace voxdag
