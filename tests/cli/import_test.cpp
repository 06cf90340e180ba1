/// Tests `voxdag import`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sponge.hpp"

namespace voxdag {
namespace {

class ImportCommand : public Sponge {};

TEST_F(ImportCommand, ExportedVoxelsComeBack) {
  ASSERT_EQ(run_voxdag({"export", path("in.vdag"), "-o", path("voxels.npy"), "-q"}).status, 0);
  const ProcessResult info = run_voxdag({"info", path("in.vdag"), "--json"});
  const nlohmann::json original = nlohmann::json::parse(info.out);
  const std::string resolution = original.at("resolution").dump();
  const ProcessResult result = run_voxdag(
      {"import", path("voxels.npy"), "-r", resolution, "-o", path("back.vdag"), "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("voxels"), original.at("voxels"));
  EXPECT_EQ(json.at("dag_nodes"), original.at("dag_nodes"));
  EXPECT_EQ(run_voxdag({"verify", path("back.vdag")}).status, 0);
  // The same bytes with any memory and any number of threads, and from the compact form.
  ASSERT_EQ(run_voxdag({"import", path("voxels.npy"), "-r", resolution, "-o", path("again.vdag"),
                        "--memory", "2G", "--threads", "1"})
                .status,
            0);
  EXPECT_EQ(read_text(path("again.vdag")), read_text(path("back.vdag")));
  ASSERT_EQ(run_voxdag({"import", path("voxels.npy"), "-r", resolution, "-o", path("small.vdag"),
                        "--compact"})
                .status,
            0);
  ASSERT_EQ(run_voxdag({"convert", path("small.vdag"), "--plain", "-o", path("again.vdag")}).status,
            0);
  EXPECT_EQ(read_text(path("again.vdag")), read_text(path("back.vdag")));
}

TEST_F(ImportCommand, PointsNeedAGrid) {
  write_text(path("p.xyz"), "0 0 0\n1 2 3\n4 4 4\n");
  const ProcessResult result =
      run_voxdag({"import", path("p.xyz"), "-r", "16", "-o", path("p.vdag")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("3 read, 3 voxels of 16³"), std::string::npos) << result.out;
  const ProcessResult inside = run_voxdag({"import", path("p.xyz"), "--voxel-size", "0.5",
                                           "--bounds", "0,0,0,2,3,4", "-o", path("p.vdag")});
  ASSERT_EQ(inside.status, 0) << inside.err;
  EXPECT_NE(inside.out.find("3 read, 1 of them outside, 2 voxels"), std::string::npos)
      << inside.out;
  const auto refused = [](std::vector<std::string> options, int status, const std::string& text) {
    options.insert(options.end(), {"-o", path("none.vdag")});
    options.insert(options.begin(), "import");
    expect_failure(run_voxdag(options), status, text);
    EXPECT_EQ(files_like("none"), 0);
  };
  refused({path("p.xyz")}, 1, "holds points, which need -r or --voxel-size");
  refused({path("p.xyz"), "-r", "16", "--voxel-size", "1"}, 2, "--voxel-size");
  refused({path("in.vdag"), "-r", "16"}, 1, "is none of .npy");
  refused({path("nothing.xyz"), "-r", "16"}, 1, "nothing.xyz");
  write_text(path("p.xyz"), "0 0 0\n1 two 3\n");
  refused({path("p.xyz"), "-r", "16"}, 1, path("p.xyz") + ": line 2: number 2");
  write_text(path("b.binvox"), "#binvox 1\ndim 4 4 4\ndata\n");
  refused({path("b.binvox"), "--voxel-size", "1"}, 1, "are for points");
  refused({path("b.binvox")}, 1, "ends after 0 of 64 values");
}

}  // namespace
}  // namespace voxdag
