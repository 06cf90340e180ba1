#include "voxdag/core/parallel/ordered_pipeline.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/with_threads.hpp"

namespace voxdag {
namespace {

std::atomic<int> alive{0};

/// A result that counts how many exist.
class Counted {
 public:
  explicit Counted(std::size_t value) : value_(value) { ++alive; }
  Counted(Counted&& other) noexcept : value_(other.value_) { ++alive; }
  Counted& operator=(Counted&&) = default;
  ~Counted() { --alive; }
  std::size_t value() const { return value_; }

 private:
  std::size_t value_;
};

template <class Make, class Use>
void run(std::size_t count, Work work, const Make& make, const Use& use) {
  with_threads(4, [&] { ordered_pipeline(count, 8, work, make, use); });
}

TEST(OrderedPipeline, UsesEveryResultInOrder) {
  for (const std::size_t count : {0, 1, 7, 8, 9, 1000}) {
    std::vector<std::size_t> used;
    run(
        count, {},
        [](std::size_t i) {
          EXPECT_LE(alive, 8 + 4 + 1);
          return Counted(i);
        },
        [&](const Counted& result) { used.push_back(result.value()); });
    std::vector<std::size_t> expected(count);
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_EQ(used, expected);
    EXPECT_EQ(alive, 0);
  }
}

TEST(OrderedPipeline, AnExceptionOfEitherSideLeavesNothingBehind) {
  for (std::size_t bad = 0; bad < 40; ++bad) {
    const auto fail_at = [&](std::size_t i) {
      if (i == bad) throw std::runtime_error("bad");
    };
    const auto make = [](std::size_t i) { return Counted(i); };
    EXPECT_THROW(run(40, {}, make, [&](const Counted& result) { fail_at(result.value()); }),
                 std::runtime_error);
    EXPECT_EQ(alive, 0);
    EXPECT_THROW(run(
                     40, {},
                     [&](std::size_t i) {
                       fail_at(i);
                       return Counted(i);
                     },
                     [](const Counted&) {}),
                 std::runtime_error);
    EXPECT_EQ(alive, 0);
  }
}

TEST(OrderedPipeline, StopsWhenCancelled) {
  Progress progress;
  std::size_t used = 0;
  EXPECT_THROW(run(
                   100'000, &progress, [](std::size_t i) { return Counted(i); },
                   [&](const Counted&) {
                     if (++used == 5) progress.cancel();
                   }),
               Cancelled);
  EXPECT_LT(used, 50u);
  EXPECT_EQ(alive, 0);
}

}  // namespace
}  // namespace voxdag
