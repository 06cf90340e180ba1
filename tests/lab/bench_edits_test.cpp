#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

TEST(BenchEdits, JsonHasTheTimesOfSessionsAndBalls) {
  const TempDir dir;
  write_text(dir / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 2 4 3\n");
  write_text(dir / "s.csv",
             "SetLocation,1,2,3\nEditSphere,1,2,3,5.0,true\nEndFrame\nEditSphere,1,2,3,9,false\n");
  ASSERT_EQ(run_voxdag({"build", dir / "m.obj", "-r", "128", "-o", dir / "m.vdag"}).status, 0);
  const ProcessResult result =
      run_voxdag({"bench", "edits", dir / "m.vdag", "--replay", dir / "s.csv", "--radius", "3,20",
                  "--repeat", "2", "--session", "30", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const auto& run = json.at("runs").at(0);
  for (const char* key : {"base_nodes", "memory_bytes", "open_seconds", "save_seconds"})
    EXPECT_GT(run.at(key), 0) << key;
  const auto& edits = run.at("edits");
  ASSERT_EQ(edits.size(), 5u);
  EXPECT_EQ(edits[0].at("edits"), 2);
  EXPECT_EQ(edits[0].at("least_radius"), 5);
  EXPECT_EQ(edits[0].at("most_radius"), 9);
  EXPECT_EQ(edits[1].at("name"), "add 3");
  for (const auto& edit : edits) EXPECT_GE(edit.at("most_ms"), edit.at("median_ms"));
  EXPECT_EQ(run.at("session").at("edits"), 30);
  EXPECT_GE(run.at("session").at("most_bytes"), run.at("session").at("early_bytes"));
}

TEST(BenchEdits, AMalformedSessionIsNamedWithItsLine) {
  const TempDir dir;
  write_text(dir / "s.csv", "EndFrame\nEditSphere,1,2,3,x,true\n");
  const ProcessResult result =
      run_voxdag({"bench", "edits", dir / "m.vdag", "--replay", dir / "s.csv"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("s.csv: line 2"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace voxdag::lab
