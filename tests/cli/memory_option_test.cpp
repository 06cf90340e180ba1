#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_dir.hpp"
#include "voxdag/core/io/process_memory.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

class CgroupMemoryLimit : public testing::Test {
 protected:
  void write(const fs::path& file, const std::string& text) {
    fs::create_directories((folder_.path() / file).parent_path());
    std::ofstream(folder_.path() / file) << text;
  }
  std::optional<std::uint64_t> limit() { return cgroup_memory_limit(folder_.path()); }

  TempDir folder_;
};

TEST_F(CgroupMemoryLimit, IsTheLeastOfTheGroupAndThoseAboveIt) {
  write("proc/self/cgroup", "0::/jobs/one\n");
  write("sys/fs/cgroup/jobs/one/memory.max", "3000\n");
  EXPECT_EQ(limit(), 3000u);
  write("sys/fs/cgroup/jobs/memory.max", "2000\n");
  EXPECT_EQ(limit(), 2000u);
  write("sys/fs/cgroup/memory.max", "5000\n");
  EXPECT_EQ(limit(), 2000u);
}

TEST_F(CgroupMemoryLimit, OfVersion1IsThatOfTheMemoryController) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/jobs\n4:memory:/jobs\n0::/\n");
  write("sys/fs/cgroup/memory/jobs/memory.limit_in_bytes", "4000\n");
  EXPECT_EQ(limit(), 4000u);
}

TEST_F(CgroupMemoryLimit, IsFoundAtTheRootInsideAContainer) {
  write("proc/self/cgroup", "0::/\n");
  EXPECT_EQ(limit(), std::nullopt);
  write("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(limit(), std::nullopt);
  write("sys/fs/cgroup/memory.max", "7000\n");
  EXPECT_EQ(limit(), 7000u);
}

TEST(MemoryOption, DefaultLeavesPartOfTheMachinesMemory) {
  std::uint64_t total_kibibytes = 0;
  std::string key;
  std::ifstream("/proc/meminfo") >> key >> total_kibibytes;
  ASSERT_EQ(key, "MemTotal:");
  EXPECT_GT(default_memory_limit(), 0u);
  EXPECT_LE(default_memory_limit(), total_kibibytes * 1024 / 4 * 3);
}

TEST(MemoryOption, BudgetCountsWhatTheProgramHoldsAlready) {
  const MemoryBudget budget = command_budget(std::uint64_t{1} << 40);
  EXPECT_EQ(budget.limit(), std::uint64_t{1} << 40);
  EXPECT_GE(budget.base(), resident_bytes());
  EXPECT_EQ(budget.used(), 0u);
}

}  // namespace
}  // namespace voxdag::cli
