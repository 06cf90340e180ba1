#pragma once
/// Runs a build under memory limits.
#include <gtest/gtest.h>

#include <cstdint>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Calls build(budget) with limits from 16 KiB to 1 GiB. Expects that it throws OverMemory below
/// some limit and keeps all limits above, and that the budget counts nothing in the end.
template <class Build>
void expect_limit_is_kept_or_refused(const Build& build) {
  bool was_refused = false, was_built = false;
  for (std::uint64_t limit = std::uint64_t{1} << 14; limit <= std::uint64_t{1} << 30; limit *= 4) {
    MemoryBudget budget(limit);
    try {
      build(budget);
      was_built = true;
      EXPECT_LE(budget.peak(), limit);
    } catch (const OverMemory&) {
      was_refused = true;
      EXPECT_FALSE(was_built) << "with less memory";
    }
    EXPECT_EQ(budget.used(), 0u);
  }
  EXPECT_TRUE(was_refused && was_built);
}

}  // namespace voxdag
