#include <algorithm>

#include "sponge.hpp"

namespace voxdag::cli {
namespace {

class RenderPath : public Sponge {
 protected:
  static ProcessResult film(const std::string& keys, std::vector<std::string> more = {},
                            const std::string& fps = "4") {
    write_text(path("keys.json"), keys);
    std::vector<std::string> arguments = {"render",    path("in.vdag"),
                                          "--path",    path("keys.json"),
                                          "-o",        path("f_%03d.png"),
                                          "--size",    "48x32",
                                          "--fps",     fps,
                                          "--ao",      "4",
                                          "--timings", path("t.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_voxdag(arguments);
  }
};

constexpr const char* kFilm =
    R"({"keys": [{"time": 1, "eye": [2, 1, 2], "target": [0.3, 0.3, 0.3], "fov": 50},
                 {"time": 2, "eye": [2, 1.5, -2], "target": [0.3, 0.3, 0.3]}]})";

TEST_F(RenderPath, WritesEachFrameAndItsTimings) {
  const ProcessResult result = film(kFilm, {"--pass", "depth=" + path("z_%d.exr")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("5 frames"), std::string::npos) << result.out;
  for (const char* name : {"f_000.png", "f_004.png", "z_0.exr", "z_4.exr"})
    EXPECT_TRUE(exists(name)) << name;
  EXPECT_FALSE(exists("f_005.png"));
  EXPECT_NE(read_text(path("f_000.png")), read_text(path("f_004.png")));
  const std::string csv = read_text(path("t.csv"));
  EXPECT_TRUE(csv.starts_with("frame,time,render_ms,write_ms,rays,mrays_per_s\n0,1,")) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
}

TEST_F(RenderPath, FramesDoNotDependOnThreads) {
  ASSERT_EQ(film(kFilm, {"--threads", "1"}).status, 0);
  const std::string one = read_text(path("f_002.png"));
  ASSERT_EQ(film(kFilm, {"--threads", "3"}).status, 0);
  EXPECT_EQ(read_text(path("f_002.png")), one);
}

TEST_F(RenderPath, TakesTheFlightOfAScene) {
  const ProcessResult flight = run_voxdag({"scene", "sponge", "--size", "2", "--path"});
  const ProcessResult result = film(flight.out, {}, "0.2");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("5 frames"), std::string::npos) << result.out;
}

/// An octree of several blocks, and films of it.
class StreamedPath : public RenderPath {
 protected:
  static void SetUpTestSuite() {
    RenderPath::SetUpTestSuite();
    ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "512", "--no-contours", "-o",
                          path("in.esvo")})
                  .status,
              0);
  }

  /// Renders a film and returns the bytes of the frames and of their depths.
  static std::string film(const std::string& keys, const std::vector<std::string>& more,
                          ProcessResult& result) {
    write_text(path("keys.json"), keys);
    std::vector<std::string> arguments = {"render",    path("in.esvo"),
                                          "--path",    path("keys.json"),
                                          "-o",        path("s_%d.png"),
                                          "--size",    "48x32",
                                          "--fps",     "2",
                                          "--ao",      "4",
                                          "--pass",    "depth=" + path("sz_%d.exr"),
                                          "--timings", path("s.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    result = run_voxdag(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    std::string frames;
    for (const char* name : {"s_0.png", "s_1.png", "s_2.png", "sz_0.exr", "sz_2.exr"}) {
      frames += read_text(path(name));
      std::filesystem::remove(path(name));
    }
    return frames;
  }
};

TEST_F(StreamedPath, FramesAreThoseOfTheWholeOctree) {
  ProcessResult result;
  const std::string whole = film(kFilm, {}, result);
  for (const std::string memory : {"1M", "1G"}) {
    EXPECT_TRUE(film(kFilm, {"--memory", memory}, result) == whole) << memory;
    EXPECT_NE(result.out.find("3 frames of 48 x 32 pixels"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(" blocks used, "), std::string::npos) << result.out;
    const std::string csv = read_text(path("s.csv"));
    EXPECT_TRUE(csv.starts_with("frame,time,render_ms,write_ms,rays,mrays_per_s\n0,1,")) << csv;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  }
  EXPECT_NE(result.out.find(" read, 0 blocks more than once"), std::string::npos) << result.out;
}

TEST_F(RenderPath, NamesThePlaceOfTheFault) {
  expect_failure(film("{\"keys\": [}"), 1, "keys.json: byte 11: syntax error");
  expect_failure(film("[]"), 1, "keys.json: must be an object");
  expect_failure(film(R"({"keys": []})"), 1, "keys.json: key 0");
  expect_failure(film(R"({"keys": [{"time": 0, "eye": [1, 2]}]})"), 1, "key 0: \"target\"");
  expect_failure(film(R"({"keys": [{"time": 0, "eye": [1, 2], "target": [0, 0, 0]}]})"), 1,
                 "key 0: \"eye\"");
  expect_failure(film(R"({"keys": [{"time": 0, "eye": [1, 2, 3], "target": [0, 0, 0]},
                                   {"time": 0, "eye": [1, 2, 4], "target": [0, 0, 0]}]})"),
                 1, "key 1: its time");
  expect_failure(film(R"({"keys": [{"time": 0, "eye": [1, 2, 3], "target": [0, 0, 0], "x": 1}]})"),
                 1, "key 0: unknown key \"x\"");
  expect_failure(film(R"({"keys": [{"time": 0, "eye": [1, 2, 3], "target": [1, 2, 3]}]})"), 1,
                 "keys.json: key 0");
  expect_failure(film(R"({"keys": [{"time": 0, "eye": [1, 2, 3], "target": [0, 0, 0]},
      {"time": 1, "eye": [0, 5, 0], "target": [0, 0, 0], "up": [0, 1, 0]}]})"),
                 1, "keys.json: key 1");
  for (const char* sun : {"[0, 0, 0]", "[1e-300, 0, 0]", "[1e300, 1e300, 0]"})
    expect_failure(film(std::string(R"({"keys": [{"time": 0, "eye": [1, 2, 3],
        "target": [0, 0, 0]}], "sun": )") +
                        sun + "}"),
                   1, "keys.json: \"sun\"");
  expect_failure(
      run_voxdag({"render", path("in.vdag"), "--path", path("keys.json"), "-o", path("plain.png")}),
      2, "%04d");
  expect_failure(
      run_voxdag({"render", path("in.vdag"), "--path", path("absent.json"), "-o", path("%d.png")}),
      1, "absent.json: cannot open: No such file");
  expect_failure(run_voxdag({"render", path("in.vdag"), "--path", path("."), "-o", path("%d.png")}),
                 1, "is a directory");
  expect_failure(
      run_voxdag({"render", path("in.vdag"), "--path", "/dev/zero", "-o", path("%d.png")}), 1,
      "/dev/zero: is neither a regular file nor a pipe");
  write_text(path("large.json"), "");
  std::filesystem::resize_file(path("large.json"), 17 << 20);
  expect_failure(
      run_voxdag({"render", path("in.vdag"), "--path", path("large.json"), "-o", path("%d.png")}),
      1, "more than the limit of 16 MiB for a camera path");
}

}  // namespace
}  // namespace voxdag::cli
