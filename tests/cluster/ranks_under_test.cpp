#include "ranks_under_test.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace voxdag {
namespace {

std::unique_ptr<Ranks>& joined() {
  static std::unique_ptr<Ranks> ranks;
  return ranks;
}

/// Leaves the job after the last test.
class Job : public testing::Environment {
 public:
  void TearDown() override { joined().reset(); }
};

const testing::Environment* const kJob = testing::AddGlobalTestEnvironment(new Job);

}  // namespace

Ranks& ranks() {
  if (joined() == nullptr) joined() = join_ranks({}, {.message_bytes = kMessageBytes});
  return *joined();
}

}  // namespace voxdag
