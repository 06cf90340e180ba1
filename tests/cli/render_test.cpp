#include "sponge.hpp"

namespace voxdag {
namespace {

class RenderCommand : public Sponge {};

TEST_F(RenderCommand, WritesPngAndExr) {
  const ProcessResult result =
      run_voxdag({"render", path("in.vdag"), "-o", path("a.png"), "--size", "64x36", "--depth",
                  path("z.exr"), "--normal", path("n.exr")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("--eye"), std::string::npos);
  EXPECT_EQ(read_text(path("a.png")).substr(1, 3), "PNG");
  for (const char* name : {"z.exr", "n.exr"})
    EXPECT_EQ(read_text(path(name)).substr(0, 4), "\x76\x2f\x31\x01") << name;
}

TEST_F(RenderCommand, TakesTheViewThatItPrints) {
  const auto render = [](std::vector<std::string> options, const std::string& name) {
    options.insert(options.begin(),
                   {"render", path("in.vdag"), "-o", path(name), "--size", "64x36"});
    return run_voxdag(options);
  };
  const std::vector<std::string> view = {"--eye", "3,2.5,-4", "--target", "0.5,0.5,0.5",
                                         "--up",  "0,1,0",    "--fov",    "40"};
  const ProcessResult first = render(view, "first.png");
  ASSERT_EQ(first.status, 0) << first.err;
  for (const std::string& word : view) EXPECT_NE(first.out.find(word), std::string::npos) << word;
  ASSERT_EQ(render(view, "second.png").status, 0);
  EXPECT_EQ(read_text(path("first.png")), read_text(path("second.png")));
}

TEST_F(RenderCommand, RefusesWhatMakesNoPicture) {
  const std::string in = path("in.vdag"), out = path("bad.png");
  expect_failure(run_voxdag({"render", in, "-o", path("bad.jpg")}), 2, ".png or .exr");
  expect_failure(run_voxdag({"render", in, "-o", out, "--size", "0x10"}), 2, "--size");
  expect_failure(run_voxdag({"render", in, "-o", out, "--eye", "1,2"}), 2, "--eye");
  expect_failure(run_voxdag({"render", in, "-o", out, "--eye", "1,1,1", "--target", "1,1,1"}), 1,
                 "in.vdag");
  expect_failure(run_voxdag({"render", path("sponge.ply"), "-o", out}), 1, "sponge.ply");
  EXPECT_FALSE(exists("bad.png"));
}

TEST_F(RenderCommand, SeesTheTrianglesOfAMesh) {
  const auto render = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", path("in.vdag"), "-o", path("mesh.png"), "--size", "64x36",
                               "--ao", "4"});
    return run_voxdag(more);
  };
  expect_failure(render({"--primary", "mesh"}), 2, "--mesh");
  expect_failure(render({"--mesh", path("absent.ply")}), 1, "absent.ply");
  ASSERT_EQ(render({}).status, 0);
  const std::string voxels = read_text(path("mesh.png"));
  ASSERT_EQ(render({"--mesh", path("sponge.ply"), "--primary", "voxels"}).status, 0);
  EXPECT_EQ(read_text(path("mesh.png")), voxels);
  ASSERT_EQ(run_voxdag({"scene", "hairball", "--size", "1", "-o", path("hair.ply")}).status, 0);
  expect_failure(render({"--mesh", path("hair.ply")}), 1, "hair.ply: the ");
  const ProcessResult result = render({"--mesh", path("sponge.ply"), "--primary", "mesh"});
  if (result.status != 0) {
    expect_failure(result, 1, "libembree-dev");
    return;
  }
  EXPECT_NE(read_text(path("mesh.png")), voxels);
}

}  // namespace
}  // namespace voxdag
