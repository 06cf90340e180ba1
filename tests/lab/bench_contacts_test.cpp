#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

TEST(BenchContacts, JsonHasTheRatesOfAllQueries) {
  const TempDir dir;
  write_text(dir / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 2 4 3\n");
  ASSERT_EQ(run_voxdag({"build", dir / "m.obj", "-r", "128", "-o", dir / "m.vdag"}).status, 0);
  const ProcessResult result =
      run_voxdag({"bench", "contacts", dir / "m.vdag", "--mesh", dir / "m.obj", "--count", "200",
                  "--radius", "4", "--repeat", "1", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("triangles"), 3);
  EXPECT_GE(json.at("rates").size(), 8u);
  for (const auto& rate : json.at("rates")) {
    EXPECT_GT(rate.at("per_ms"), 0) << rate.at("query");
    EXPECT_GT(rate.at("positive"), 0) << rate.at("query");
    // A voxel that the surface meets is at most its diagonal away.
    if (rate.at("program") != "embree") continue;
    EXPECT_GT(rate.at("difference_voxels"), 0) << rate.at("query");
    EXPECT_LT(rate.at("difference_voxels"), 1.8) << rate.at("query");
  }
}

}  // namespace
}  // namespace voxdag::lab
