/// Every command opens its input once: a file that is replaced meanwhile is one file to it.
#include "npy_rays.hpp"
#include "sponge.hpp"
#include "support/open_count.hpp"

namespace voxdag::cli {
namespace {

using Words = std::vector<std::string>;

class OpenOnce : public Sponge {
 protected:
  static void SetUpTestSuite() {
    Sponge::SetUpTestSuite();
    make({"build", path("sponge.ply"), "-r", "32", "--normal", "-o", path("plain.vdag")});
    make({"convert", path("plain.vdag"), "--compact", "-o", path("compact.vdag")});
    make({"convert", path("plain.vdag"), "--compact", "--wire", "-o", path("wire.vdag")});
    make({"build", path("sponge.ply"), "-r", "32", "-o", path("octree.esvo")});
    write_text(path("rays.npy"), rays_npy({{0, 9, 0, 0, 0, -1, 0, 1}}));
  }

  static void make(const Words& command) {
    const ProcessResult result = run_voxdag(command);
    ASSERT_EQ(result.status, 0) << result.err;
  }

  /// Runs `command FILE options` for each file and expects that it succeeds and opens FILE once.
  static void expect_one_open(const Words& files, const std::string& command,
                              const Words& options = {}) {
    for (const std::string& file : files) {
      Words words = {command, path(file)};
      words.insert(words.end(), options.begin(), options.end());
      OpenCount count(path(file));
      const ProcessResult result = run_voxdag(words);
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(count.take(), 1) << command << ' ' << file;
    }
  }

  static inline const Words kDags = {"plain.vdag", "compact.vdag", "wire.vdag"};
  static inline const Words kScenes = {"plain.vdag", "compact.vdag", "wire.vdag", "octree.esvo"};
};

TEST_F(OpenOnce, TheCounterSeesEveryOpen) {
  OpenCount count(path("in.vdag"));
  EXPECT_EQ(count.take(), 0);
  for (int i = 0; i < 3; ++i) read_text(path("in.vdag"));
  EXPECT_EQ(count.take(), 3);
}

TEST_F(OpenOnce, Info) {
  expect_one_open(kScenes, "info");
  expect_one_open(kScenes, "info", {"--json"});
}

TEST_F(OpenOnce, Verify) {
  expect_one_open(kScenes, "verify");
  expect_one_open(kScenes, "verify", {"--mesh", path("sponge.ply"), "--samples", "10"});
}

TEST_F(OpenOnce, Render) {
  const Words picture = {"--size", "16x16", "-o", path("a.png")};
  expect_one_open(kScenes, "render", picture);
  Words streamed = {"--memory", "16M"};
  streamed.insert(streamed.end(), picture.begin(), picture.end());
  expect_one_open({"octree.esvo"}, "render", streamed);
}

TEST_F(OpenOnce, Export) {
  expect_one_open(kScenes, "export", {"-o", path("a.ply")});
  expect_one_open(kDags, "export", {"-o", path("a.html")});
}

TEST_F(OpenOnce, Convert) {
  expect_one_open(kDags, "convert", {"--plain", "-o", path("a.vdag")});
  expect_one_open(kDags, "coarsen", {"--by", "1", "-o", path("a.vdag")});
}

TEST_F(OpenOnce, Trace) {
  const Words rays = {"--rays", path("rays.npy"), "-o", path("hits.npy")};
  expect_one_open(kScenes, "trace", rays);
  Words in_place = {"--in-place"};
  in_place.insert(in_place.end(), rays.begin(), rays.end());
  expect_one_open({"compact.vdag"}, "trace", in_place);
}

TEST_F(OpenOnce, Query) { expect_one_open(kDags, "query", {"--count"}); }

TEST_F(OpenOnce, Edits) {
  expect_one_open(kDags, "crop",
                  {"--window", "0,0,0,8,8,8", "--drop-attributes", "-o", path("a.vdag")});
  expect_one_open(kDags, "fill", {"--drop-attributes", "-o", path("a.vdag")});
}

}  // namespace
}  // namespace voxdag::cli
