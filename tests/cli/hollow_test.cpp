/// `voxdag hollow` and `voxdag query --thickness`, of a block of 20 x 20 x 10 mm.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

class Hollow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    write_text(
        path("block.obj"),
        "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 20 20 0\nv 0 0 10\nv 20 0 10\nv 0 20 10\nv 20 20 10\n"
        "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    const auto build = [](std::vector<std::string> words) {
      words.insert(words.begin(), {"build", path("block.obj"), "--voxel-size", "0.5", "--bounds",
                                   "-1,-1,-1,31,31,31"});
      ASSERT_EQ(run_voxdag(words).status, 0);
    };
    build({"--solid", "--unit", "mm", "-o", path("mm.vdag")});
    build({"--solid", "-o", path("none.vdag")});
    build({"--unit", "mm", "-o", path("shell.vdag")});
  }
  static void TearDownTestSuite() { delete dir_; }
  static std::string path(const std::string& name) { return *dir_ / name; }
  static ProcessResult hollow(const std::string& file, std::vector<std::string> words) {
    words.insert(words.begin(), {"hollow", path(file), "-o", path("out.vdag")});
    return run_voxdag(words);
  }
  static nlohmann::json json_of(std::vector<std::string> words) {
    words.push_back("--json");
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  static std::uint64_t voxels_of(const std::string& file) {
    return json_of({"query", path(file), "--count"})["voxels"];
  }

  static inline TempDir* dir_ = nullptr;
};

TEST_F(Hollow, TheWallIsALengthInAnyUnit) {
  ASSERT_EQ(voxels_of("mm.vdag"), 40u * 40 * 20);
  for (const char* wall : {"2mm", "2", "0.2cm", "0.002m", "0.0787401574803149606in"}) {
    ASSERT_EQ(hollow("mm.vdag", {"--wall", wall}).status, 0) << wall;
    EXPECT_EQ(voxels_of("out.vdag"), 40u * 40 * 20 - 32u * 32 * 12) << wall;
    EXPECT_EQ(run_voxdag({"verify", path("out.vdag")}).status, 0);
  }
  ASSERT_EQ(hollow("none.vdag", {"--wall", "2", "--threads", "1"}).status, 0);
  EXPECT_EQ(voxels_of("out.vdag"), 40u * 40 * 20 - 32u * 32 * 12);
}

TEST_F(Hollow, DrainsOpenTheCavity) {
  ASSERT_EQ(
      hollow("mm.vdag", {"--wall", "2mm", "--drain", "10,10,0,1.5mm", "--drain", "10,10,10,0.15cm"})
          .status,
      0);
  const std::uint64_t open = voxels_of("out.vdag");
  EXPECT_LT(open, 40u * 40 * 20 - 32u * 32 * 12);
  ASSERT_EQ(run_voxdag({"fill", path("out.vdag"), "-o", path("filled.vdag")}).status, 0);
  EXPECT_EQ(voxels_of("filled.vdag"), open);
}

TEST_F(Hollow, WhatCannotBeDoneIsOneLine) {
  expect_failure(hollow("none.vdag", {"--wall", "2mm"}), 1, "build the file with --unit");
  expect_failure(hollow("shell.vdag", {"--wall", "1mm"}), 1, "`voxdag fill` or build --solid");
  expect_failure(hollow("mm.vdag", {"--wall", "6mm"}), 1, "deeper than the wall");
  expect_failure(hollow("mm.vdag", {"--wall", "0.1mm"}), 1, "the wall must have one at least");
  expect_failure(hollow("mm.vdag", {"--wall", "2yd"}), 2, "none of mm, cm, m, in and ft");
  expect_failure(hollow("mm.vdag", {"--wall", "-2"}), 2, "--wall");
  expect_failure(hollow("mm.vdag", {"--wall", "2", "--drain", "1,2"}), 2, "--drain");
  expect_failure(hollow("mm.vdag", {"--wall", "2", "--drain", "10,10,5,0.6"}), 1,
                 "drain 1 does not");
  expect_failure(hollow("mm.vdag", {"--wall", "2", "--memory", "1M"}), 1, "memory limit");
}

TEST_F(Hollow, ThicknessIsWrittenAndCounted) {
  ASSERT_EQ(hollow("mm.vdag", {"--wall", "1.5mm"}).status, 0);  // Plates of three voxels.
  const nlohmann::json json = json_of(
      {"query", path("out.vdag"), "--thickness", "--thinner", "1.5mm", "-o", path("thin.npy")});
  EXPECT_EQ(json["voxels"], voxels_of("out.vdag"));
  EXPECT_EQ(json["unit"], "mm");
  EXPECT_EQ(json["least"], 0.5);  // A voxel at an edge of the block.
  EXPECT_LE(json["mean"], json["most"]);
  std::uint64_t sum = 0, thin = 0;
  for (std::size_t bin = 0; bin < json["histogram"].size(); ++bin) {
    const std::uint64_t count = json["histogram"][bin];
    sum += count;
    if (bin < 3) thin += count;
  }
  EXPECT_EQ(sum, json["voxels"]);
  EXPECT_EQ(thin, json["thinner"]);
  // The middles of the plates are as thick as the wall.
  EXPECT_LT(json["thinner"].get<double>(), 0.2 * json["voxels"].get<double>());
  const std::string shape = "'shape': (" + json["thinner"].dump() + ", 3)";
  const std::string rows = read_text(path("thin.npy"));
  EXPECT_NE(rows.find(shape), std::string::npos);
  EXPECT_EQ(rows.size() - rows.find('\n') - 1, thin * sizeof(Vec3i));

  ASSERT_EQ(run_voxdag({"query", path("out.vdag"), "--thickness", "--window", "12,12,0,13,13,8",
                        "-o", path("column.npy"), "-q"})
                .status,
            0);
  const std::string text = read_text(path("column.npy"));
  float column[8];
  std::memcpy(column, text.data() + text.size() - sizeof column, sizeof column);
  for (int z = 0; z < 8; ++z) EXPECT_EQ(column[z], z >= 2 && z < 5 ? 1.5f : 0.0f) << z;
}

TEST_F(Hollow, ThicknessIsRefusedWhereItHasNoMeaning) {
  const auto query = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"query", path("none.vdag")});
    return run_voxdag(words);
  };
  expect_failure(query({"--thickness", "--thinner", "1mm"}), 1, "build the file with --unit");
  expect_failure(query({"--area", "--thinner", "1"}), 2, "--thinner");
  expect_failure(query({"--thickness", "--window", "0,0,0,1,1,1"}), 2, "--window");
  expect_failure(query({"--thickness", "--memory", "1M"}), 1, "memory limit");
}

}  // namespace
}  // namespace voxdag::cli
