// Labels from `voxdag import`, and `voxdag materials`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

class MaterialsCommand : public testing::Test {
 protected:
  MaterialsCommand() {
    // A row of three classes, and a noise point.
    write_text(dir_ / "p.csv", "x,y,z,class\n0,0,0,2\n1,0,0,2\n2,0,0,6\n3,0,0,5\n3,3,3,7\n");
  }
  std::string path(const std::string& name) const { return dir_ / name; }
  ProcessResult import(std::vector<std::string> more) const {
    std::vector<std::string> words{"import", path("p.csv"), "--voxel-size",
                                   "1",      "-o",          path("p.vdag")};
    words.insert(words.end(), more.begin(), more.end());
    return run_voxdag(words);
  }
  nlohmann::json list(const std::string& name) const {
    const ProcessResult result = run_voxdag({"materials", path(name), "--json"});
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out).at("materials");
  }

  TempDir dir_;
};

TEST_F(MaterialsCommand, ListsAndKeepsLabels) {
  EXPECT_NE(import({"--labels"}).out.find("labels        4"), std::string::npos);
  const nlohmann::json all = list("p.vdag");
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].at("label"), 2);
  EXPECT_EQ(all[0].at("name"), "2");
  EXPECT_EQ(all[0].at("voxels"), 2);
  EXPECT_EQ(all[0].at("window"), nlohmann::json({0, 0, 0, 2, 1, 1}));
  EXPECT_EQ(all[0].at("bounds"), nlohmann::json({-0.5, -0.5, -0.5, 1.5, 0.5, 0.5}));

  EXPECT_EQ(run_voxdag({"materials", path("p.vdag"), "--keep", "2,6", "-o", path("k.vdag")}).status,
            0);
  EXPECT_EQ(run_voxdag({"materials", path("p.vdag"), "--drop", "5,7", "-o", path("d.vdag")}).status,
            0);
  for (const char* const name : {"k.vdag", "d.vdag"}) {
    const nlohmann::json kept = list(name);
    EXPECT_EQ(kept[0].at("voxels"), 2);
    EXPECT_EQ(kept[1].at("voxels"), 0);
    EXPECT_EQ(kept[2].at("voxels"), 1);
    EXPECT_EQ(kept[3].at("voxels"), 0);
    EXPECT_EQ(run_voxdag({"verify", path(name)}).status, 0);
  }
  expect_failure(run_voxdag({"materials", path("p.vdag"), "--keep", "water", "-o", path("n.vdag")}),
                 1, "has no material 'water'");
  expect_failure(run_voxdag({"materials", path("p.vdag"), "-o", path("n.vdag")}), 2, "--output");
  expect_failure(run_voxdag({"materials", path("p.vdag"), "--keep", "2"}), 2, "--keep");
}

TEST_F(MaterialsCommand, ImportKeepsLabelsThatAreAskedFor) {
  EXPECT_EQ(import({"--drop", "7"}).status, 0);
  EXPECT_EQ(list("p.vdag").size(), 3u);
  const ProcessResult kept = import({"--keep", "2", "--json"});
  EXPECT_EQ(nlohmann::json::parse(kept.out).at("unwanted"), 3);
  EXPECT_EQ(list("p.vdag").size(), 1u);
  EXPECT_EQ(import({}).status, 0);
  expect_failure(run_voxdag({"materials", path("p.vdag")}), 1, "has no material ids");
  expect_failure(import({"--label-field", "floor"}), 1, "has no field 'floor'");
  expect_failure(import({"--keep", "2", "--drop", "6"}), 2, "--");
}

}  // namespace
}  // namespace voxdag::cli
