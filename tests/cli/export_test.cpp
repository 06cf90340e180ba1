/// `voxdag export` to the formats of other programs. tests/exports tests the content of the files.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "sponge.hpp"

namespace voxdag::cli {
namespace {

using ExportCommand = Sponge;

TEST_F(ExportCommand, WritesTheFormatOfTheExtension) {
  for (const char* name : {"a.glb", "a.obj", "a.stl", "a.vox", "a.binvox", "a.schem",
                           "a.voxel.json", "a.ply", "a.npy", "a.raw"}) {
    const ProcessResult result = run_voxdag({"export", path("in.vdag"), "-o", path(name)});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with(path(name) + ": ")) << result.out;
    EXPECT_NE(result.out.find(" voxels, "), result.out.npos) << result.out;
    EXPECT_GT(std::filesystem::file_size(path(name)), 0u);
  }
  EXPECT_TRUE(std::filesystem::exists(path("a.voxel.bin")));
  EXPECT_TRUE(std::filesystem::exists(path("a.vox.json")));
}

TEST_F(ExportCommand, VoxelsComeBackFromOtherFormats) {
  for (const char* name : {"r.vox", "r.binvox", "r.npy"}) {
    ASSERT_EQ(run_voxdag({"export", path("in.vdag"), "-o", path(name), "-q"}).status, 0);
    const std::string back = path(std::string(name) + ".vdag");
    const ProcessResult import = run_voxdag({"import", path(name), "-o", back, "-q"});
    ASSERT_EQ(import.status, 0) << import.err;
    const auto voxels = [&](const std::string& file) {
      return run_voxdag({"query", file, "--count", "--json"}).out;
    };
    EXPECT_EQ(voxels(back), voxels(path("in.vdag")));
  }
}

TEST_F(ExportCommand, SlicesAreAFolderOfPictures) {
  const ProcessResult result = run_voxdag(
      {"export", path("in.vdag"), "--slices", "x", "--window", "0,0,0,3,8,9", "-o", path("s/")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(path("s/slice_0002.png")));
  EXPECT_FALSE(std::filesystem::exists(path("s/slice_0003.png")));
  expect_failure(run_voxdag({"export", path("in.vdag"), "--slices", "x", "-o", path("s")}), 1,
                 "exists and is not an empty folder");
  expect_failure(run_voxdag({"export", path("in.vdag"), "--slices", "x", "-o", path("t.html")}), 1,
                 "--slices writes a folder");
  expect_failure(run_voxdag({"export", path("in.vdag"), "--grey", "-o", path("t.html")}), 2,
                 "on a page");
  expect_failure(run_voxdag({"export", path("in.vdag"), "--slices", "w", "-o", path("t")}), 2,
                 "--slices");
}

TEST_F(ExportCommand, UnknownExtensionsAreRefusedWithThoseThatAreKnown) {
  expect_failure(
      run_voxdag({"export", path("in.vdag"), "-o", path("a.fbx")}), 1,
      "a.fbx: cannot export to '.fbx': the extension must be .spc.npy, .npy, .raw, .ply, .glb, "
      ".obj, .stl, .3mf, .vox, .binvox, .schem, .voxel.json, .nrrd, .mha, .mhd, "
      ".vti, .nii, .nii.gz, .vdb or .nvdb, or .html; a folder ends in "
      "/");
  expect_failure(run_voxdag({"export", path("in.vdag"), "-o", path("a.stl"), "--grey"}), 2,
                 "--grey");
}

/// Runs a command line of the shell. $V is the program; the current folder is that of the tests.
ProcessResult run_shell(const std::string& folder, const std::string& line) {
  return Process({"sh", "-c", "cd \"$0\"; V=$1; " + line, folder, voxdag_command({})[0]}).wait();
}

TEST_F(ExportCommand, StandardInputAndOutputAreDashes) {
  for (const char* line :
       {"$V export in.vdag --format obj -o - | $V build - --format obj -r 32 -o p.vdag",
        "$V build - -r 32 -o p.vdag < sponge.ply",
        "$V build /dev/stdin -r 32 -o p.vdag < sponge.ply",
        "cat sponge.ply | $V build /dev/stdin -r 32 -o p.vdag",
        "gzip -c sponge.ply | $V build - -r 32 -o p.vdag",
        "gzip -c sponge.ply > s.ply.gz; $V build s.ply.gz -r 32 -o - > p.vdag",
        "$V export in.vdag --format ply -o - > p.ply; $V import - --format ply -o p.vdag < "
        "p.ply"}) {
    std::filesystem::remove(path("p.vdag"));
    const ProcessResult result = run_shell(dir_->path().string(), line);
    EXPECT_EQ(result.status, 0) << line << result.err;
    EXPECT_EQ(run_voxdag({"verify", path("p.vdag"), "-q"}).status, 0) << line;
  }
  const ProcessResult none = run_shell(dir_->path().string(), "$V build - -r 32 -o p.vdag");
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.err, "voxdag: -: is not a regular file\n");
}

TEST_F(ExportCommand, ANamelessImportNeedsAFormat) {
  const ProcessResult result =
      run_shell(dir_->path().string(), "echo 1 2 3 | $V import - --voxel-size 1 -o p.vdag");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err, "voxdag: -: has no ending that tells its format: --format does\n");
}

TEST_F(ExportCommand, OptionsOfMeshesOfFacesExcludeEachOther) {
  const auto size_of = [&](const std::vector<std::string>& options, const std::string& name) {
    std::vector<std::string> arguments{"export", path("in.vdag"), "-o", path(name), "-q"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_voxdag(arguments).status, 0);
    return std::filesystem::file_size(path(name));
  };
  EXPECT_LT(size_of({"--merge"}, "m.glb"), size_of({"--manifold"}, "n.glb"));
  EXPECT_EQ(size_of({}, "w.glb"), size_of({"--watertight"}, "v.glb"));
  EXPECT_EQ(size_of({}, "m.stl"), size_of({"--manifold"}, "n.stl"));
  EXPECT_EQ(size_of({}, "m.stl"), size_of({"--smooth"}, "s.stl"));
  EXPECT_GT(size_of({"--smooth"}, "s.glb"), size_of({"--watertight"}, "v.glb"));
  EXPECT_LT(size_of({"--smooth"}, "s.3mf"), size_of({"--smooth"}, "s.stl"));
  EXPECT_GT(size_of({"--smooth"}, "s.ply"), size_of({"--faces"}, "f.ply"));
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--merge", "-o", "a.stl"},
        {"--manifold", "-o", "a.ply"},
        {"--merge", "--manifold", "-o", "a.glb"},
        {"--smooth", "--manifold", "-o", "a.glb"},
        {"--smooth", "-o", "a.vox"},
        {"--manifold", "-o", "a.3mf"},
        {"--skip-empty", "-o", "a.stl"},
        {"--up", "x", "-o", "a.glb"},
        {"--texture", "-o", "a.stl"}}) {
    std::vector<std::string> arguments{"export", path("in.vdag")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_voxdag(arguments).status, 2);
  }
}

TEST_F(ExportCommand, NeverOverwritesItsInputBesideTheOutput) {
  std::filesystem::copy_file(path("in.vdag"), path("q.voxel.bin"));
  expect_failure(run_voxdag({"export", path("q.voxel.bin"), "-o", path("q.voxel.json")}), 2,
                 "an input file");
}

TEST_F(ExportCommand, TheSummaryCountsVoxelsAndFaces) {
  const auto summary = [](const std::string& name, std::vector<std::string> options) {
    options.insert(options.begin(), {"export", path("in.vdag"), "-o", path(name), "--json"});
    return nlohmann::json::parse(run_voxdag(options).out);
  };
  const auto voxels = nlohmann::json::parse(
      run_voxdag({"query", path("in.vdag"), "--count", "--json"}).out)["voxels"];
  const auto faces = nlohmann::json::parse(
      run_voxdag({"query", path("in.vdag"), "--area", "--json"}).out)["faces"];
  const std::int64_t squares =
      faces[0].get<std::int64_t>() + faces[1].get<std::int64_t>() + faces[2].get<std::int64_t>();
  const auto stl = summary("n.stl", {"--watertight"});
  EXPECT_EQ(stl["voxels"], voxels);
  EXPECT_EQ(stl["triangles"], 2 * squares);
  EXPECT_EQ(stl["bytes"], std::filesystem::file_size(path("n.stl")));
  EXPECT_EQ(summary("n.ply", {"--faces"})["faces"], squares);
  EXPECT_EQ(summary("n.npy", {}).count("faces"), 0u);
  EXPECT_EQ(summary("n.html", {})["voxels"], voxels);
  EXPECT_EQ(summary("n.raw", {"--window", "0,0,0,1,1,1"})["bytes"], 1);
}

}  // namespace
}  // namespace voxdag::cli
