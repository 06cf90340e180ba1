#include <gtest/gtest.h>

#include <csignal>

#include "json.hpp"
#include "npy_rays.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

using Json = nlohmann::json;

/// A tetrahedron whose longest side is 4 units along x.
constexpr const char* kMesh =
    "v 1 2 3\nv 5 2 3\nv 1 4 3\nv 1 2 5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class Build : public testing::Test {
 protected:
  Build() { write_text(mesh_, kMesh); }

  ProcessResult build(std::vector<std::string> options, const std::string& output) const {
    options.insert(options.begin(), {"build", mesh_, "-o", output});
    return run_voxdag(options);
  }
  ProcessResult build(std::vector<std::string> options) const { return build(options, output_); }

  /// Expects that the mesh is the only file: no output and no partial output.
  void expect_nothing_left() const { EXPECT_EQ(dir_.count(), 1); }

  TempDir dir_;
  std::string mesh_ = dir_ / "mesh.obj", output_ = dir_ / "out.vdag";
};

TEST_F(Build, SummaryIsATableOnStandardOutput) {
  const ProcessResult result = build({"-r", "64"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");
  for (const char* text : {"64³ voxels", "4 triangles", "SVO", "DAG", "voxels/s", "peak memory"})
    EXPECT_NE(result.out.find(text), std::string::npos) << text;
  EXPECT_EQ(dir_.count(), 2);
}

TEST_F(Build, AMeshFarFromZeroIsBuiltAndVerifiedAsPreciselyAsOneNearIt) {
  const auto box_at = [](int x, int y) {
    const auto vertex = [&](const char* at) {
      return "v " + std::to_string(x) + at + " " + std::to_string(y) + at + " 0" + at + "\n";
    };
    return vertex(".1125") + vertex(".48125") + "v " + std::to_string(x) + ".1125 " +
           std::to_string(y) + ".39062 0.2\nf 1 2 3\n";
  };
  const auto build_at = [&](int x, int y, const std::string& output) {
    write_text(mesh_, box_at(x, y));
    const std::string lo = std::to_string(x) + "," + std::to_string(y) + ",0,",
                      hi = std::to_string(x) + ".8," + std::to_string(y) + ".8,0.8";
    EXPECT_EQ(build({"-r", "256", "--bounds", lo + hi}, output).status, 0);
    const ProcessResult verified = run_voxdag({"verify", output, "--mesh", mesh_});
    EXPECT_EQ(verified.status, 0) << verified.err;
    return Json::parse(run_voxdag({"info", output, "--json"}).out);
  };
  const Json near = build_at(0, 0, dir_ / "near.vdag"),
             far = build_at(500000, 4649776, dir_ / "far.vdag");
  EXPECT_EQ(near.at("voxels"), far.at("voxels"));
  EXPECT_EQ(far.at("transform").at("origin"), (Json{500000, 4649776, 0}));
  // The grid around the mesh has its origin at the mesh's lower corner.
  EXPECT_EQ(build({"-r", "64"}).status, 0);
  const Json around = Json::parse(run_voxdag({"info", output_, "--json"}).out);
  EXPECT_NEAR(around.at("transform").at("origin").at(0), 500000.1125, 1e-8);
}

TEST_F(Build, AMeshWithFarPartsIsAWarningIfItsVoxelsAreSmall) {
  write_text(mesh_, std::string(kMesh) + "v 3000000 0 0\nv 3000001 0 0\nv 3000000 1 0\nf 5 6 7\n");
  EXPECT_EQ(build({"-r", "64", "-q"}).err, "");
  std::vector<std::string> options = {"--bounds", "0,0,0,8,8,8", "-r", "64", "-q"};
  for (int i = 0; i < 2; ++i) {
    const ProcessResult result = build(options);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err,
              "voxdag: warning: " + mesh_ +
                  ": vertices, in float32, may be off by 0.18, and a voxel has 0.12: parts "
                  "of the mesh are far from each other or from 0\n");
    options.insert(options.end(), {"--parts", "2"});
  }
}

TEST_F(Build, ATriangleThatIsLeftOutIsAWarning) {
  write_text(mesh_, std::string(kMesh) + "v nan 0 0\nf 1 2 5\n");
  const ProcessResult result = build({"-r", "64", "-q"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err,
            "voxdag: warning: " + mesh_ + ": 1 triangle left out: a vertex is not finite\n");
}

TEST_F(Build, QuietPrintsNothing) {
  const ProcessResult result = build({"-r", "64", "--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Build, InfoAndBuildPrintTheSameValues) {
  const ProcessResult built = build({"-r", "32", "--json"});
  ASSERT_EQ(built.status, 0) << built.err;
  const Json summary = Json::parse(built.out);
  const Json info = Json::parse(run_voxdag({"info", output_, "--json"}).out);
  for (const auto& [key, value] : info.items()) EXPECT_EQ(summary.at(key), value) << key;
  EXPECT_GT(summary.at("seconds").at("total"), 0);
  EXPECT_GT(summary.at("peak_memory_bytes"), 0);
}

TEST_F(Build, InfoCountsAgreeWithEachOther) {
  ASSERT_EQ(build({"-r", "32"}).status, 0);
  const Json info = Json::parse(run_voxdag({"info", output_, "--json"}).out);
  EXPECT_EQ(info.at("resolution"), 32);
  EXPECT_EQ(info.at("levels"), 5);
  ASSERT_EQ(info.at("svo_nodes_per_level").size(), 5u);
  ASSERT_EQ(info.at("dag_nodes_per_level").size(), 5u);
  std::uint64_t svo = 0, dag = 0;
  for (const std::uint64_t count : info.at("svo_nodes_per_level")) svo += count;
  for (const std::uint64_t count : info.at("dag_nodes_per_level")) dag += count;
  EXPECT_EQ(info.at("svo_nodes"), svo);
  EXPECT_EQ(info.at("dag_nodes"), dag);
  EXPECT_EQ(info.at("bytes").at("svo_pointerless"), svo);
  EXPECT_EQ(info.at("bytes").at("file"), std::filesystem::file_size(output_));
  EXPECT_DOUBLE_EQ(info.at("bits_per_voxel").at("svo_pointerless"),
                   8.0 * static_cast<double>(svo) / info.at("voxels").get<double>());
  EXPECT_EQ(info.at("source").at("name"), "mesh.obj");
  EXPECT_EQ(info.at("transform").at("origin"), Json::array({1, 2, 3}));
}

TEST_F(Build, InfoTableHasEveryLevel) {
  ASSERT_EQ(build({"-r", "32"}).status, 0);
  const ProcessResult info = run_voxdag({"info", output_});
  EXPECT_EQ(info.status, 0);
  for (const char* level : {"\n  0 ", "\n  4 "})
    EXPECT_NE(info.out.find(level), std::string::npos) << info.out;
}

TEST_F(Build, VoxelSizeTakesTheSmallestGridThatHoldsTheMesh) {
  ASSERT_EQ(build({"--voxel-size", "0.1"}).status, 0);
  const Json info = Json::parse(run_voxdag({"info", output_, "--json"}).out);
  EXPECT_EQ(info.at("resolution"), 64);
  EXPECT_EQ(info.at("transform").at("voxel_size"), 0.1);
}

TEST_F(Build, BoundsPlaceTheGrid) {
  ASSERT_EQ(build({"-r", "16", "--bounds", "-1,-2,-3,7,6,5"}).status, 0);
  const Json info = Json::parse(run_voxdag({"info", output_, "--json"}).out);
  EXPECT_EQ(info.at("transform").at("origin"), Json::array({-1, -2, -3}));
  EXPECT_GT(info.at("voxels"), 0);
}

TEST_F(Build, ABuildWithoutVoxelsIsAWarningAndAFileThatAllCommandsTake) {
  // A degenerate triangle has no edges, so only its box can keep it out of a grid that lies
  // elsewhere.
  write_text(mesh_, std::string(kMesh) + "f 1 1 1\n");
  for (const std::string output : {dir_ / "none.vdag", dir_ / "none.esvo"}) {
    const ProcessResult built = build({"-r", "16", "--bounds", "9,9,9,10,10,10"}, output);
    EXPECT_EQ(built.status, 0);
    EXPECT_EQ(built.err,
              "voxdag: warning: " + output +
                  ": no voxels: no visible part of the mesh's surface lies in the grid\n");
    EXPECT_EQ(Json::parse(run_voxdag({"info", output, "--json"}).out).at("voxels"), 0);
    const std::string picture = dir_ / "none.png", points = dir_ / "none.ply";
    const std::string rays = dir_ / "rays.npy", hits = dir_ / "hits.npy";
    write_text(rays, rays_npy({{9.5f, 9.5f, 8, 0, 0, 0, 1, 100}}));
    for (const auto& command : {std::vector<std::string>{"verify", output, "--mesh", mesh_},
                                {"render", output, "--size", "16x12", "-o", picture},
                                {"trace", output, "--rays", rays, "-o", hits},
                                {"export", output, "-o", points}}) {
      const ProcessResult result = run_voxdag(command);
      EXPECT_EQ(result.status, 0) << command[0] << ": " << result.err;
    }
  }
}

TEST_F(Build, AllMethodsWriteTheSameBytes) {
  const std::string other = dir_ / "sorted.vdag";
  ASSERT_EQ(build({"-r", "128"}).status, 0);
  for (const char* method : {"sort", "paper"})
    for (const char* threads : {"1", "2"}) {
      ASSERT_EQ(build({"-r", "128", "--method", method, "--threads", threads}, other).status, 0);
      EXPECT_EQ(read_text(output_), read_text(other)) << method;
    }
}

TEST_F(Build, AnOutputOfAnEarlierBuildIsReplaced) {
  write_text(output_, "old");
  ASSERT_EQ(build({"-r", "16"}).status, 0);
  EXPECT_EQ(run_voxdag({"verify", output_}).status, 0);
}

TEST_F(Build, BadUsageIsRefusedBeforeAnyWork) {
  expect_failure(build({"-r", "64", "--voxel-size", "1"}), 2, "not both");
  expect_failure(build({"-r", "0"}), 2, "from 1 to 1048576");
  expect_failure(build({"-r", "1025K"}), 2, "from 1 to 1048576");
  expect_failure(build({"-r", "64", "--snap"}), 2, "--snap");
  expect_failure(build({"-r", "64", "--up", "w"}), 2, "none of x, y and z");
  expect_failure(build({"-r", "64", "--bounds", "0,0,0,1,1"}), 2, "6 numbers");
  expect_failure(build({"--voxel-size", "-1"}), 2, "greater than zero");
  expect_failure(build({"-r", "64", "--method", "magic"}), 2, "--method");
  expect_failure(build({"-r", "64", "--memory", "much"}), 2, "--memory");
  expect_failure(build({"-r", "64", "--threads", "0"}), 2, "--threads");
  expect_nothing_left();
}

TEST_F(Build, AMissingMeshIsNamed) {
  const std::string absent = dir_ / "absent.obj";
  expect_failure(run_voxdag({"build", absent, "-r", "64", "-o", output_}), 1, absent);
  expect_nothing_left();
}

TEST_F(Build, ADamagedMeshIsNamedWithTheLine) {
  write_text(mesh_, "v 1 2 3\nv 4 5 6\nf 1 2 3\n");
  expect_failure(build({"-r", "64"}), 1, mesh_ + ": line 3");
  expect_nothing_left();
}

TEST_F(Build, AnUnwritableOutputIsFoundBeforeTheMeshIsRead) {
  const std::string nowhere = dir_ / "no/such/folder/out.vdag";
  write_text(mesh_, "this is not a mesh");
  expect_failure(build({"-r", "64"}, nowhere), 1, nowhere);
  expect_nothing_left();
}

TEST_F(Build, AFullDiskIsAClearError) {
  expect_failure(build({"-r", "64"}, "/dev/full"), 1, "/dev/full");
  expect_nothing_left();
}

TEST_F(Build, AFileNameWithALineBreakStillMakesOneLine) {
  expect_failure(run_voxdag({"build", dir_ / "a\nb.obj", "-r", "64", "-o", output_}), 1, "a b.obj");
}

/// Starts a long build, waits until it handles signals, and sends it one.
ProcessResult interrupted_build(const std::string& mesh, const std::string& output, int number) {
  Process build(voxdag_command({"build", mesh, "-r", "1048576", "-o", output, "--threads", "1"}));
  build.wait_until_it_catches(SIGINT);
  build.send_signal(number);
  return build.wait();
}

/// Returns triangles in all directions, which take long at a high resolution.
std::string long_work(unsigned triangles = 3000) {
  std::string text;
  for (unsigned i = 0; i < 3 * triangles; ++i)
    text += "v " + std::to_string(i * 7919 % 997) + " " + std::to_string(i * 104729 % 991) + " " +
            std::to_string(i * 15485863 % 983) + "\n";
  for (unsigned i = 1; i <= 3 * triangles; i += 3)
    text +=
        "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  return text;
}

TEST_F(Build, InterruptsStopItAndLeaveNothing) {
  write_text(mesh_, long_work());
  expect_failure(interrupted_build(mesh_, output_, SIGINT), 128 + SIGINT, "cancelled");
  expect_nothing_left();
  expect_failure(interrupted_build(mesh_, output_, SIGTERM), 128 + SIGTERM, "cancelled");
  expect_nothing_left();
}

TEST_F(Build, AKilledBuildLeavesNothing) {
  write_text(mesh_, long_work());
  EXPECT_EQ(interrupted_build(mesh_, output_, SIGKILL).status, 128 + SIGKILL);
  expect_nothing_left();
}

TEST_F(Build, AKilledBuildOfAnEsvoLeavesNothing) {
  // An ESVO build writes blocks early.
  write_text(mesh_, long_work(300));
  const std::string output = dir_ / "out.esvo";
  Process build(voxdag_command({"build", mesh_, "-r", "2048", "-o", output, "--threads", "1"}));
  ASSERT_TRUE(build.wait_until_it_writes(dir_.path()));
  build.send_signal(SIGKILL);
  EXPECT_EQ(build.wait().status, 128 + SIGKILL);
  expect_nothing_left();
}

TEST_F(Build, TooLittleMemoryIsRefused) {
  write_text(mesh_, long_work());
  expect_failure(run_voxdag({"build", mesh_, "-r", "65536", "-o", output_, "--memory", "20M"}), 1,
                 "memory");
  expect_nothing_left();
}

TEST_F(Build, VerifyPassesWithTheMesh) {
  ASSERT_EQ(build({"-r", "64"}).status, 0);
  const ProcessResult result = run_voxdag({"verify", output_, "--mesh", mesh_});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("cover"), std::string::npos);
}

TEST_F(Build, VerifyNamesTheCheckThatFails) {
  ASSERT_EQ(build({"-r", "64"}).status, 0);
  std::string bytes = read_text(output_);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_text(output_, bytes);
  ProcessResult result = run_voxdag({"verify", output_, "--json"});
  EXPECT_FALSE(Json::parse(result.out).at("passed"));
  result.out.clear();
  expect_failure(result, 1, output_ + ": checksums");
}

TEST_F(Build, VerifyFindsTheWrongMesh) {
  const std::string octree = dir_ / "out.esvo";
  ASSERT_EQ(build({"-r", "64"}).status, 0);
  ASSERT_EQ(build({"-r", "64", "--as", "esvo"}, octree).status, 0);
  EXPECT_EQ(run_voxdag({"verify", octree, "--mesh", mesh_}).status, 0);
  write_text(mesh_, "v 1 2 3\nv 5 2 3\nv 1 4 3.5\nf 1 2 3\n");
  EXPECT_EQ(run_voxdag({"verify", output_, "--mesh", mesh_}).status, 1);
  EXPECT_EQ(run_voxdag({"verify", octree, "--mesh", mesh_}).status, 1);
  // A mesh that is far away.
  write_text(mesh_, "v 1001 2 3\nv 1005 2 3\nv 1001 4 3.5\nf 1 2 3\n");
  ProcessResult result = run_voxdag({"verify", octree, "--mesh", mesh_});
  result.out.clear();
  expect_failure(result, 1, "no point of " + mesh_ + " is in the grid");
}

TEST_F(Build, SolidSetsTheInsideOfAClosedMesh) {
  ASSERT_EQ(build({"-r", "64"}).status, 0);
  const auto voxels_of = [this](const std::string& file) {
    const ProcessResult result = run_voxdag({"info", file, "--json"});
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out);
  };
  const std::string solid = dir_ / "solid.vdag", flood = dir_ / "flood.vdag",
                    filled = dir_ / "filled.vdag";
  ASSERT_EQ(build({"-r", "64", "--solid"}, solid).status, 0);
  const Json info = voxels_of(solid);
  EXPECT_EQ(info.at("build").at("solid"), "parity");
  // A third of the corner of a cube of 64 by 32 by 32 voxels: 64 * 32 * 32 / 6 and half a surface.
  EXPECT_GT(info.at("voxels"), voxels_of(output_).at("voxels"));
  EXPECT_NEAR(info.at("voxels").get<double>(), 64 * 32 * 32 / 6.0, 3'000);
  ASSERT_EQ(build({"-r", "64", "--solid", "flood"}, flood).status, 0);
  // They keep the voxels that the body only touches, along an edge of the face at the grid's side.
  EXPECT_EQ(voxels_of(flood).at("voxels"), info.at("voxels").get<int>() + 33);
  ASSERT_EQ(run_voxdag({"fill", output_, "-o", filled}).status, 0);
  EXPECT_EQ(voxels_of(filled).at("voxels"), info.at("voxels").get<int>() + 33);
  for (const std::string& file : {solid, flood}) {
    const ProcessResult verified = run_voxdag({"verify", file, "--mesh", mesh_});
    EXPECT_EQ(verified.status, 0) << verified.out;
    EXPECT_NE(verified.out.find("solid"), std::string::npos) << verified.out;
  }
  // A file that says so, but is a shell.
  const std::string cut = dir_ / "cut.vdag";
  ASSERT_EQ(run_voxdag({"erode", solid, "--steps", "2", "-o", cut}).status, 0);
  const ProcessResult wrong = run_voxdag({"verify", cut, "--mesh", mesh_});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.out.find("voxels differ from the inside"), std::string::npos) << wrong.out;
}

TEST_F(Build, AnOpenMeshHasNoInside) {
  write_text(mesh_, "v 1 2 3\nv 5 2 3\nv 1 4 3\nv 1 2 5\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const ProcessResult result = build({"-r", "64", "--solid"});
  expect_failure(result, 1, "the mesh is not closed: 3 edges belong to an odd number of triangles");
  expect_nothing_left();
  EXPECT_NE(result.err.find("--solid winding"), std::string::npos) << result.err;
  expect_failure(build({"-r", "64", "--solid", "full"}), 2, "none of parity, winding and flood");
  expect_failure(build({"-r", "64", "--solid", "flood", "--rule", "centre"}), 2, "--rule");
  expect_failure(build({"-r", "64", "--color", "--inside-color", "1,2,3"}), 2, "--inside-color");
}

TEST_F(Build, AnOpenMeshIsFilledByItsWindingNumber) {
  write_text(mesh_, "v 1 2 3\nv 5 2 3\nv 1 4 3\nv 1 2 5\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const auto voxels = [this](const std::vector<std::string>& options) {
    EXPECT_EQ(build(options).status, 0);
    const Json info = Json::parse(run_voxdag({"info", output_, "--json"}).out);
    const ProcessResult verified = run_voxdag({"verify", output_, "--mesh", mesh_});
    EXPECT_EQ(verified.status, 0) << verified.out;
    return info.at("voxels").get<int>();
  };
  const int shell = voxels({"-r", "64"}), solid = voxels({"-r", "64", "--solid", "winding"}),
            narrow = voxels({"-r", "64", "--solid", "winding", "--winding-threshold", "0.8"}),
            wide = voxels({"-r", "64", "--solid", "winding", "--winding-threshold", "0.3"});
  EXPECT_LT(shell, narrow);
  EXPECT_LT(narrow, solid);
  EXPECT_LT(solid, wide);
  // The hole is flat, so that the winding number on it is 1/2.
  EXPECT_NEAR(solid, 64 * 32 * 32 / 6.0, 3'000);
  expect_failure(build({"-r", "64", "--solid", "--winding-threshold", "0.3"}), 2,
                 "--winding-threshold");
  expect_failure(build({"-r", "64", "--solid", "winding", "--winding-threshold", "0"}), 2,
                 "greater than zero");
}

}  // namespace
}  // namespace voxdag::cli
