#include "voxdag/stored/svdag/long_svdag.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/long_form.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag {
namespace {

/// Runs all checks; returns the first fault.
std::string fault(const LongForm& form) {
  const LongSvdagView view = form.view();
  try {
    validate_svdag(view);
    check_canonical(view);
    check_minimal(view);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

LongForm two_corners() { return long_form(brute_svdag(5, {{0, 0, 0}, {31, 31, 31}})); }

TEST(LongSvdag, ChecksAndCountsAreThoseOfThePlainForm) {
  for (int levels = 2; levels <= 8; ++levels)
    for (unsigned seed = 0; seed < 10; ++seed) {
      const Svdag dag = brute_svdag(levels, random_voxels(levels, 1 + 17 * seed, seed));
      const LongForm form = long_form(dag);
      EXPECT_EQ(fault(form), "");
      EXPECT_EQ(count_svdag(form.view()), count_svdag(dag.view()));
    }
}

TEST(LongSvdag, PointersKeepAll35Bits) {
  for (const std::uint64_t pointer : {std::uint64_t{0}, std::uint64_t{0xFFFFFFFF},
                                      std::uint64_t{5} << 32 | 123, kMaxLongWords - 1})
    for (int child = 0; child < 8; ++child) {
      const std::uint32_t node[] = {1u << child | upper_bits_of(pointer, child),
                                    static_cast<std::uint32_t>(pointer)};
      LongSvdagView view;
      view.nodes = node;
      EXPECT_EQ(child_place(view, 0, 0, child), pointer);
    }
}

TEST(LongSvdag, BitsOfAMissingChildAreRefused) {
  LongForm form = two_corners();  // the root has the children 0 and 7
  form.dag.nodes[0] |= upper_bits_of(std::uint64_t{1} << 32, 3);
  EXPECT_EQ(fault(form), "level 0, word 0: mask word has pointer bits of a child that is missing");
}

TEST(LongSvdag, UpperBitsCountInChecks) {
  LongForm form = two_corners();
  form.dag.nodes[0] |= upper_bits_of(std::uint64_t{1} << 32, 7);
  EXPECT_EQ(fault(form), "level 0, word 2: pointer points outside the next level");
  form = two_corners();
  form.dag.nodes[form.dag.level_begin[2]] |= upper_bits_of(std::uint64_t{1} << 32, 0);
  EXPECT_EQ(fault(form), "level 2, word 8: pointer is past the last leaf block");
}

TEST(LongSvdag, AMaskWordWithoutChildrenIsRefused) {
  LongForm form = two_corners();
  form.dag.nodes[0] &= ~0xFFu;
  EXPECT_EQ(fault(form), "level 0, word 0: node has no children");
}

}  // namespace
}  // namespace voxdag
