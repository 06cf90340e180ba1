#include <gtest/gtest.h>

#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

class ExportPage : public testing::Test {
 protected:
  ExportPage() {
    const std::string mesh = dir_ / "mesh.ply";
    EXPECT_EQ(run_voxdag({"scene", "city", "--size", "1", "-o", mesh, "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"build", mesh, "-r", "256", "-o", plain_, "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"convert", plain_, "--compact", "-o", small_, "--quiet"}).status, 0);
  }

  TempDir dir_;
  std::string plain_ = dir_ / "plain.vdag", small_ = dir_ / "small.vdag";
};

TEST_F(ExportPage, AFolderAndAFile) {
  const ProcessResult folder = run_voxdag({"export", plain_, "-o", dir_ / "site/"});
  EXPECT_EQ(folder.status, 0) << folder.err;
  EXPECT_TRUE(folder.out.starts_with((dir_ / "site/").string() + ": ")) << folder.out;
  EXPECT_EQ(read_text(dir_ / "site/scene.vdag"), read_text(plain_));
  const ProcessResult file = run_voxdag({"export", small_, "-o", dir_ / "a.html"});
  EXPECT_EQ(file.status, 0) << file.err;
  EXPECT_EQ(file.err, "");
  EXPECT_TRUE(read_text(dir_ / "a.html").starts_with("<!doctype html>"));
}

TEST_F(ExportPage, LevelsMakeItCoarser) {
  ASSERT_EQ(run_voxdag({"convert", plain_, "--levels", "5", "-o", dir_ / "5.vdag"}).status, 0);
  ASSERT_EQ(run_voxdag({"export", plain_, "--levels", "5", "-o", dir_ / "site/"}).status, 0);
  EXPECT_EQ(read_text(dir_ / "site/scene.vdag"), read_text(dir_ / "5.vdag"));
  expect_failure(run_voxdag({"export", plain_, "--levels", "9", "-o", dir_ / "b/"}), 1,
                 "has 8 levels, so that it cannot get 9");
  expect_failure(run_voxdag({"export", plain_, "--levels", "5", "-o", dir_ / "a.npy"}), 2,
                 "--levels");
}

TEST_F(ExportPage, WrongOutputsAreRefused) {
  expect_failure(run_voxdag({"export", plain_, "-o", dir_.path()}), 2, "is the folder of");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "no/site/"}), 1, "cannot create");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "no/a.html"}), 1, "no/a.html");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "a.xyz"}), 1, "cannot export");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "a.html", "--faces"}), 2, "--faces");
}

}  // namespace
}  // namespace voxdag
