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

/// Films by programs that stand for ffmpeg.
class FilmFiles : public RenderPath {
 protected:
  /// Renders a film of 5 frames with `program`, a shell script, as ffmpeg; without one, no ffmpeg
  /// is on PATH.
  static ProcessResult film(const std::string& name, const std::string& program,
                            const std::vector<std::string>& more = {}) {
    const std::string bin = path("bin");
    std::filesystem::remove_all(bin);
    std::filesystem::create_directory(bin);
    if (!program.empty()) {
      write_text(bin + "/ffmpeg", "#!/bin/sh\n" + program);
      std::filesystem::permissions(bin + "/ffmpeg", std::filesystem::perms::owner_all);
    }
    write_text(path("keys.json"), kFilm);
    std::vector<std::string> command = {"env",
                                        "PATH=" + bin + (program.empty() ? "" : ":/usr/bin:/bin")};
    const std::vector<std::string> voxdag =
        voxdag_command({"render", path("in.vdag"), "--path", path("keys.json"), "-o", path(name),
                        "--fps", "4", "--ao", "4"});
    command.insert(command.end(), voxdag.begin(), voxdag.end());
    command.insert(command.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--size") == more.end())
      command.insert(command.end(), {"--size", "48x32"});
    return Process(command).wait();
  }
};

/// Writes its arguments, and the frames as the film. The last argument is the film.
constexpr const char* kRecords = R"sh(
echo "$@" > "$(dirname "$0")/arguments"
while [ $# -gt 1 ]; do
  if [ "$1" = -i ]; then frames=$(dirname "$2"); fi
  shift
done
cat "$frames"/frame_*.png > "$1"
)sh";

TEST_F(FilmFiles, AreMadeOfTheFrames) {
  ASSERT_EQ(RenderPath::film(kFilm).status, 0);
  std::string frames;
  for (int i = 0; i < 5; ++i) frames += read_text(path("f_00" + std::to_string(i) + ".png"));
  for (const auto& [name, codec] : {std::pair("a.mp4", "libx264"), {"b.webm", "libvpx-vp9"}}) {
    const ProcessResult result = film(name, kRecords);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("5 frames of 48 x 32 pixels"), std::string::npos) << result.out;
    EXPECT_TRUE(read_text(path(name)) == frames);
    EXPECT_EQ(files_like(name), 1);  // The frames are gone.
    const std::string arguments = read_text(path("bin/arguments"));
    EXPECT_NE(arguments.find("-framerate 4 -i /"), std::string::npos) << arguments;
    EXPECT_NE(arguments.find(codec), std::string::npos) << arguments;
  }
}

TEST_F(FilmFiles, AFailureKeepsTheFramesAndSaysTheCommand) {
  for (const char* program :
       {"", "echo one >&2; echo two words >&2; touch x.mp4; exit 3", "exit 0"}) {
    const ProcessResult result = film("bad film.mp4", program);
    expect_failure(result, 1, "bad film.mp4: ffmpeg");
    const std::string kept = path("bad film.mp4.frames");
    EXPECT_NE(result.err.find("; this makes the film: ffmpeg -loglevel error -y -framerate 4 -i '" +
                              kept + "/frame_%06d.png' "),
              std::string::npos)
        << result.err;
    EXPECT_FALSE(exists("bad film.mp4"));
    EXPECT_EQ(files_like("bad film"), 1);
    EXPECT_TRUE(exists("bad film.mp4.frames/frame_000004.png"));
    EXPECT_FALSE(exists("bad film.mp4.frames/log"));
    if (std::string_view(program).starts_with("echo")) {
      EXPECT_NE(result.err.find("ffmpeg failed (two words)"), std::string::npos) << result.err;
    }
    // The command that it says makes the film.
    film("other.mp4", kRecords);
    const std::string line = result.err.substr(result.err.find("ffmpeg -loglevel"));
    const ProcessResult typed = Process({"sh", "-c", "PATH=$0:$PATH; " + line, path("bin")}).wait();
    EXPECT_EQ(typed.status, 0) << typed.err;
    EXPECT_TRUE(exists("bad film.mp4"));
    expect_failure(film("bad film.mp4", kRecords), 1, "bad film.mp4.frames: exists");
    std::filesystem::remove_all(kept);
    std::filesystem::remove(path("bad film.mp4"));
  }
}

TEST_F(FilmFiles, AreRefusedWithWhatTheyCannotHold) {
  expect_failure(film("a%d.mp4", kRecords), 2, "is one film, whose name has no %");
  expect_failure(film("a.mp4", kRecords, {"--size", "47x32"}), 2, "must be even numbers");
  expect_failure(film("a.mp4", kRecords, {"--background", "transparent"}), 1, "has no alpha");
  expect_failure(run_voxdag({"render", path("in.vdag"), "-o", path("c.mp4")}), 2, "needs --path");
  EXPECT_FALSE(exists("c.mp4"));
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
