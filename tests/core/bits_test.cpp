#include "voxdag/core/bits.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(Bits, Popcount8CountsEveryByte) {
  for (std::uint32_t v = 0; v < 256; ++v) EXPECT_EQ(popcount8(v), popcount(v)) << v;
}

TEST(Bits, FloatsAndTheirBitsAreInverse) {
  for (const float f : {0.0f, -0.0f, 1.0f, -3.5f, 1e-45f})
    EXPECT_EQ(bits_of_float(float_from_bits(bits_of_float(f))), bits_of_float(f));
  EXPECT_EQ(bits_of_float(1.0f), 0x3F800000u);
}

TEST(Bits, HighestAndLowestAreTheEnds) {
  EXPECT_EQ(highest_bit(1), 0);
  EXPECT_EQ(highest_bit(0x80000001u), 31);
  EXPECT_EQ(lowest_bit64(0x8000000000000000u), 63);
  EXPECT_EQ(lowest_bit64(6), 1);
}

}  // namespace
}  // namespace voxdag
