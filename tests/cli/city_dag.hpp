#pragma once
/// A small city as a DAG in both forms.
#include <gtest/gtest.h>

#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {

/// A fixture with files that are made anew for each test.
class CityDag : public testing::Test {
 protected:
  CityDag() {
    EXPECT_EQ(run_voxdag({"scene", "city", "--size", "1", "-o", mesh_, "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"build", mesh_, "-r", "256", "-o", plain_, "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"convert", plain_, "--compact", "-o", small_, "--quiet"}).status, 0);
  }

  TempDir dir_;
  std::string mesh_ = dir_ / "mesh.ply", plain_ = dir_ / "plain.vdag", small_ = dir_ / "small.vdag";
};

}  // namespace voxdag::cli
