#pragma once
/// The smallest procedural scene as a mesh and as a DAG.
#include <gtest/gtest.h>

#include "cli/process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {

/// A fixture with files that are made once for all tests of a program.
class Sponge : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    ASSERT_EQ(run_voxdag({"scene", "sponge", "--size", "2", "-o", path("sponge.ply")}).status, 0);
    ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "32", "-o", path("in.vdag")}).status,
              0);
  }
  static void TearDownTestSuite() { delete dir_; }

  static std::string path(const std::string& name) { return *dir_ / name; }
  static bool exists(const std::string& name) { return std::filesystem::exists(path(name)); }
  /// Returns the number of files, with temporary ones, whose names begin with `start`.
  static int files_like(const std::string& start) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(dir_->path()))
      files += entry.path().filename().string().starts_with(start);
    return files;
  }

  static inline TempDir* dir_ = nullptr;
};

}  // namespace voxdag::cli
