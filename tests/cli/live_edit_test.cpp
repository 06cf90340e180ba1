/// `voxdag edit`: scripts, JSON, stamps and replays, against other commands and lists of voxels.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "sponge.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag::cli {
namespace {

/// A grid of 32³ voxels of side 1 at (0,0,0), with a mesh of a cube from 4 to 12.
class LiveEdit : public Sponge {
 protected:
  using Voxel = std::array<int, 3>;
  using Voxels = std::set<Voxel>;

  static void SetUpTestSuite() {
    Sponge::SetUpTestSuite();
    write("cube.obj", cube(4, 12));
    ASSERT_EQ(run_voxdag({"build", path("cube.obj"), "--bounds", "0,0,0,32,32,32", "--voxel-size",
                          "1", "--solid", "-o", path("a.vdag")})
                  .status,
              0);
    ASSERT_EQ(run_voxdag({"build", path("cube.obj"), "--bounds", "0,0,0,32,32,32", "--voxel-size",
                          "1", "--solid", "--color", "-o", path("c.vdag")})
                  .status,
              0);
  }
  static std::string cube(int lo, int hi) {
    std::string text;
    for (int i = 0; i < 8; ++i)
      text += fmt::format("v {} {} {}\n", (i & 1) != 0 ? hi : lo, (i & 2) != 0 ? hi : lo,
                          (i & 4) != 0 ? hi : lo);
    for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"})
      text += std::string("f ") + face + "\n";
    return text;
  }
  static void write(const std::string& name, const std::string& text) {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  /// Applies a script to a file. Returns the JSON summary.
  static nlohmann::json edit(const std::string& in, const std::string& script,
                             const std::vector<std::string>& options = {}) {
    write("script.csv", script);
    std::vector<std::string> words = {"edit", path(in),         "--script", path("script.csv"),
                                      "-o",   path("out.vdag"), "--json"};
    words.insert(words.end(), options.begin(), options.end());
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << script << result.err;
    EXPECT_EQ(run_voxdag({"verify", path("out.vdag")}).status, 0) << script;
    return nlohmann::json::parse(result.out, nullptr, false);
  }
  static Voxels voxels_of(const std::string& file) {
    EXPECT_EQ(run_voxdag({"export", path(file), "-o", path("voxels.npy"), "-q"}).status, 0);
    const std::string text = read_text(path("voxels.npy"));
    const std::size_t begin = text.find('\n') + 1;
    Voxels voxels;
    for (std::size_t at = begin; at + 12 <= text.size(); at += 12) {
      std::int32_t v[3];
      std::memcpy(v, text.data() + at, sizeof v);
      voxels.insert({v[0], v[1], v[2]});
    }
    return voxels;
  }
  /// Returns the voxels of the file after a change of each cell of the grid.
  static Voxels where(const std::function<bool(Vec3d centre, bool is_set)>& has) {
    const Voxels before = voxels_of("a.vdag");
    Voxels after;
    for (int z = 0; z < 32; ++z)
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
          if (has({x + 0.5, y + 0.5, z + 0.5}, before.contains({x, y, z}))) after.insert({x, y, z});
    return after;
  }
};

bool in_ball(Vec3d p, Vec3d center, double radius) {
  const Vec3d d = p - center;
  return dot(d, d) <= radius * radius;
}
bool in_box(Vec3d p, Vec3d lo, Vec3d hi) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < lo[axis] || p[axis] >= hi[axis]) return false;
  return true;
}

TEST_F(LiveEdit, EachOperationChangesItsVoxels) {
  const std::pair<std::string, std::function<bool(Vec3d, bool)>> cases[] = {
      {"remove,ball,8,8,12,3",
       [](Vec3d p, bool is) {
         return is && !in_ball(p, {8, 8, 12}, 3);
       }},
      {"add,ball,8,8,12,3",
       [](Vec3d p, bool is) {
         return is || in_ball(p, {8, 8, 12}, 3);
       }},
      {"add,box,2,3,4,7,20,6",
       [](Vec3d p, bool is) {
         return is || in_box(p, {2, 3, 4}, {7, 20, 6});
       }},
      {"remove,halfspace,8,8,8,0,0,1", [](Vec3d p, bool is) { return is && p.z >= 8; }},
      {"add,capsule,4,4,20,12,4,20,2",
       [](Vec3d p, bool is) {
         const Vec3d nearest{std::min(std::max(p.x, 4.0), 12.0), 4, 20};
         return is || in_ball(p, nearest, 2);
       }},
      {"remove,turnedbox,8,8,8,6,1,1,0,0,0.70710678118654757,0.70710678118654757",
       [](Vec3d p, bool is) {
         return is && !in_box(p, {7, 2, 7}, {9, 14, 9});
       }},
      {"copy,4,4,4,12,12,12,20,20,20",
       [](Vec3d p, bool is) {
         return is || in_box(p, {20, 20, 20}, {28, 28, 28});
       }},
      {"move,4,4,4,12,12,12,20,20,20",
       [](Vec3d p, bool) {
         return in_box(p, {20, 20, 20}, {28, 28, 28});
       }},
      {"shrink,ball,8,8,8,30",
       [](Vec3d p, bool) {
         return in_box(p, {5, 5, 5}, {11, 11, 11});
       }},
  };
  ASSERT_EQ(voxels_of("a.vdag"), where([](Vec3d p, bool) {
              return in_box(p, {4, 4, 4}, {12, 12, 12});
            }));
  for (const auto& [script, has] : cases) {
    const nlohmann::json json = edit("a.vdag", script + "\n");
    EXPECT_EQ(voxels_of("out.vdag"), where(has)) << script;
    EXPECT_EQ(json.at("edits"), 1);
    EXPECT_EQ(json.at("undo_depth"), 1);
    EXPECT_GT(json.at("new_bytes"), 0);
    EXPECT_EQ(json.at("voxels"), where(has).size());
  }
  edit("a.vdag", "grow,ball,8,8,8,30\nsmooth,ball,8,8,8,30\n");
}

TEST_F(LiveEdit, EditsThatChangeNothingAreReported) {
  const auto says_so = [](const std::string& first, const std::string& second) {
    const ProcessResult result =
        run_voxdag({"edit", path("a.vdag"), "--do", first, "--do", second, "-o", path("o.vdag")});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err.find("the edits changed no voxel") != result.err.npos;
  };
  EXPECT_TRUE(says_so("add,ball,8,8,8,1", "remove,ball,99,99,99,1"));
  EXPECT_TRUE(says_so("remove,ball,8,8,8,1", "add,ball,8,8,8,1"));
  EXPECT_FALSE(says_so("add,ball,8,8,8,1", "remove,ball,8,8,8,1"));
}

TEST_F(LiveEdit, OptionsStandardInputAndFormsGiveTheSameFile) {
  const std::string ball = "remove,ball,8,8,12,3", box = "add,box,2,3,4,7,20,6";
  edit("a.vdag", "# a script\r\n\r\n" + ball + "\r\nundo\r\nredo\r\n" + box + "\r\n");
  const std::string expected = read_text(path("out.vdag"));
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "edit");
    words.insert(words.end(), {"-o", path("same.vdag")});
    EXPECT_EQ(run_voxdag(words).status, 0);
    return voxels_of("same.vdag");
  };
  const Voxels voxels = voxels_of("out.vdag");
  EXPECT_EQ(run({path("a.vdag"), "--do", ball, "--do", box}), voxels);
  EXPECT_EQ(run({path("a.vdag"), "--do",
                 R"({"op": "remove", "shape": "ball", "center": [8, 8, 12], "radius": 3})", "--do",
                 R"({"op": "add", "shape": "box", "min": [2, 3, 4], "max": [7, 20, 6]})"}),
            voxels);
  EXPECT_EQ(run({path("a.vdag"), "--script", path("script.csv"), "--threads", "1"}), voxels);
  EXPECT_EQ(read_text(path("same.vdag")), expected);
  EXPECT_EQ(run({path("a.vdag"), "--script", path("script.csv"), "--threads", "3"}), voxels);
  EXPECT_EQ(read_text(path("same.vdag")), expected);
  EXPECT_EQ(run({path("a.vdag"), "--script", path("script.csv"), "--compact"}), voxels);
}

TEST_F(LiveEdit, ColoursArePaintedAndKept) {
  using Color = std::array<std::uint8_t, 3>;
  const auto colors_of = [](const std::string& file) {
    EXPECT_EQ(run_voxdag({"export", path(file), "-o", path("colors.npy"), "-q"}).status, 0);
    const std::string text = read_text(path("colors.npy"));
    std::map<Voxel, Color> colors;
    for (std::size_t at = text.find('\n') + 1; at + 15 <= text.size(); at += 15) {
      std::int32_t v[3];
      Color color;
      std::memcpy(v, text.data() + at, sizeof v);
      std::memcpy(color.data(), text.data() + at + 12, 3);
      colors[{v[0], v[1], v[2]}] = color;
    }
    return colors;
  };
  std::map<Voxel, Color> expected = colors_of("c.vdag");
  ASSERT_EQ(expected.size(), voxels_of("a.vdag").size());
  for (auto& [voxel, color] : expected)
    if (voxel[2] < 8) color = {255, 128, 0};
  for (int i = 0; i < 8; ++i)
    expected[{20 + (i & 1), 20 + (i >> 1 & 1), 20 + (i >> 2)}] = {1, 2, 3};
  edit("c.vdag", "paint,box,0,0,0,32,32,8,#ff8000\nadd,box,20,20,20,22,22,22,#010203\n");
  EXPECT_EQ(colors_of("out.vdag"), expected);
  for (int i = 0; i < 1000; ++i) expected[{5 + i % 10, 5 + i / 10 % 10, 5 + i / 100}] = {4, 5, 6};
  for (const char* last :
       {"replace,box,5,5,5,15,15,15,#040506\n",
        R"({"op": "replace", "shape": "box", "min": [5, 5, 5], "max": [15, 15, 15],)"
        R"( "color": "#040506"})"}) {
    edit("c.vdag", std::string("paint,box,0,0,0,32,32,8,#ff8000\n"
                               "add,box,20,20,20,22,22,22,#010203\n") +
                       last);
    EXPECT_EQ(colors_of("out.vdag"), expected) << last;
  }
  edit("c.vdag", "remove,ball,8,8,8,3\n", {"--drop-attributes"});
  edit("a.vdag", "remove,ball,8,8,8,3\n");
  const std::string plain = read_text(path("out.vdag"));
  edit("c.vdag", "remove,ball,8,8,8,3\n");
  EXPECT_GT(read_text(path("out.vdag")).size(), plain.size());
}

TEST_F(LiveEdit, ASceneWithoutVoxelsIsEditedAndKeepsItsColours) {
  const auto exported = [](const char* file) {
    EXPECT_EQ(run_voxdag({"export", path(file), "-o", path("voxels.npy"), "-q"}).status, 0);
    return read_text(path("voxels.npy"));
  };
  const std::string
      all = "remove,halfspace,0,0,99,0,0,1\n",
      script = "add,ball,8,8,8,5,#ff8000\npaint,ball,8,8,12,3,#0080ff\nadd,ball,20,8,8,3\n";
  edit("c.vdag", all + script);
  const std::string expected = exported("out.vdag");
  for (const std::string form : {"--plain", "--compact"}) {
    edit("c.vdag", all, {form});
    std::filesystem::rename(path("out.vdag"), path("empty.vdag"));
    const std::string nothing = exported("empty.vdag");
    EXPECT_LT(nothing.size(), expected.size());
    edit("empty.vdag", script);
    EXPECT_EQ(exported("out.vdag"), expected);
    edit("empty.vdag", "add,ball,8,8,8,5\nundo\ngrow,ball,8,8,8,9\ncopy,0,0,0,9,9,9,9,9,9\n");
    EXPECT_EQ(exported("out.vdag"), nothing);
  }
  edit("c.vdag", all, {"--drop-attributes"});
  expect_failure(run_voxdag({"edit", path("out.vdag"), "--do", "add,ball,8,8,8,5,#ff8000", "-o",
                             path("none.vdag")}),
                 1, "the DAG has no colours");
}

TEST_F(LiveEdit, StampsComeFromFilesMeshesAndLists) {
  const auto is_a = [](Vec3d p, bool is) { return is || in_box(p, {1, 2, 3}, {9, 10, 11}); };
  edit("a.vdag", fmt::format(R"({{"op": "stamp", "file": "{}", "at": [1, 2, 3]}})"
                             "\n",
                             path("a.vdag")));
  EXPECT_EQ(voxels_of("out.vdag"), where(is_a));
  edit("a.vdag", fmt::format(R"({{"op": "stamp", "file": "{}", "solid": true, "at": [1, 2, 3]}})",
                             path("cube.obj")));
  EXPECT_EQ(voxels_of("out.vdag"), where(is_a));
  // A mesh in its place has the voxels that `voxdag build` gives it.
  write("other.obj", cube(7, 21));
  ASSERT_EQ(run_voxdag(
                {"build", path("other.obj"), "--grid-of", path("a.vdag"), "-o", path("other.vdag")})
                .status,
            0);
  ASSERT_EQ(run_voxdag({"combine", path("a.vdag"), path("other.vdag"), "--subtract", "-o",
                        path("minus.vdag")})
                .status,
            0);
  edit("a.vdag",
       fmt::format(R"({{"op": "stamp", "file": "{}", "mode": "remove"}})", path("other.obj")));
  EXPECT_EQ(voxels_of("out.vdag"), voxels_of("minus.vdag"));
  edit("a.vdag", R"({"op": "remove", "voxels": [[4, 4, 4], [5, 4, 4]]})");
  EXPECT_EQ(voxels_of("out.vdag"), where([](Vec3d p, bool is) {
              return is && !in_box(p, {4, 4, 4}, {6, 5, 5});
            }));
  ASSERT_EQ(run_voxdag({"export", path("other.vdag"), "-o", path("list.npy"), "-q"}).status, 0);
  edit("a.vdag", fmt::format(R"({{"op": "remove", "voxels": "{}"}})", path("list.npy")));
  EXPECT_EQ(voxels_of("out.vdag"), voxels_of("minus.vdag"));
  // Voxels (0,0), (1,0), (2,0) and (0,1), mirrored and turned, replace their box: it loses two.
  write("corner.obj", "v 4.5 4.5 4.5\nv 6.5 4.5 4.5\nv 4.5 5.5 4.5\nf 1 2 2\nf 1 3 3\n");
  edit("a.vdag", fmt::format(R"({{"op": "stamp", "file": "{}", "at": [4, 4, 4], "turn": ["z", 1], )"
                             R"("mirror": "x", "mode": "replace"}})",
                             path("corner.obj")));
  EXPECT_EQ(voxels_of("out.vdag"), where([](Vec3d p, bool is) {
              return is && !in_box(p, {4, 4, 4}, {5, 6, 5});
            }));
}

TEST_F(LiveEdit, AnErrorNamesTheFileAndTheLineAndNothingIsWritten) {
  const std::pair<std::string, std::string> cases[] = {
      {"remove,ball,1,2,3,1\n\nremove,cube,1\n", "script.csv: line 3: 'cube' is no shape"},
      {"undo\n", "line 1: there is nothing to undo"},
      {"paint,ball,1,2,3,4,#ff0000\n", "line 1: the DAG has no colours"},
      {"replace,ball,1,2,3,4,#ff0000\n", "line 1: the DAG has no colours"},
      {R"({"op": "replace", "shape": "ball", "center": [1, 2, 3], "radius": 3})",
       "line 1: replace needs a colour"},
      {"{\"op\": \"undo\"\n", "line 1: is no object of JSON"},
      {R"({"op": "undo", "twice": 1})", "line 1: 'twice' is no member of this edit"},
      {R"({"op": "remove", "shape": "ball", "center": [1, 2], "radius": 3})",
       "'center' must be an array of 3 numbers"},
      {R"({"op": "remove", "shape": "ball", "center": [1, 2, 3]})", "'radius' must be a number"},
      {R"({"op": "add", "voxels": [[1, 2, 32]]})", "lies outside of the grid"},
      {R"({"op": "add", "voxels": [[1, 2, 0.5]]})", "'voxels' must be arrays of 3 whole numbers"},
      {R"({"op": "add", "voxels": [[1, 2, 4294967296]]})", "'voxels' must be arrays"},
      {R"({"op": "stamp", "file": "none.vdag"})", "line 1: none.vdag: "},
      {R"({"op": "stamp", "file": "none.vdag", "mode": "join"})", "'mode' must be"},
      {R"({"op": "stamp", "file": "none.vdag", "turn": ["w", 1]})", "'turn' must have an axis"},
  };
  for (const auto& [script, text] : cases) {
    write("script.csv", script);
    expect_failure(run_voxdag({"edit", path("a.vdag"), "--script", path("script.csv"), "-o",
                               path("none.vdag")}),
                   1, text);
    EXPECT_EQ(files_like("none"), 0) << script;
  }
  expect_failure(run_voxdag({"edit", path("a.vdag"), "--do", "carve", "-o", path("none.vdag")}), 1,
                 "--do carve: 'carve' is no edit");
  expect_failure(run_voxdag({"edit", path("a.vdag"), "-o", path("none.vdag")}), 2,
                 "one of --script, --replay and --do is required");
  expect_failure(run_voxdag({"edit", path("a.vdag"), "--script", path("script.csv"), "-o",
                             path("script.csv")}),
                 2, "--output");
  expect_failure(run_voxdag({"edit", path("a.vdag"), "--script", path("missing.csv"), "-o",
                             path("none.vdag")}),
                 1, "missing.csv: cannot open");
  expect_failure(
      run_voxdag({"edit", path("a.vdag"), "--history", "1", "--do", "grow,ball,8,8,8,9", "--do",
                  "grow,ball,8,8,8,9", "--do", "undo", "--do", "undo", "-o", path("none.vdag")}),
      1, "there is nothing to undo");
  expect_failure(run_voxdag({"edit", path("a.vdag"), "--do",
                             fmt::format(R"({{"op": "stamp", "file": "{}"}})", path("b.vdag")),
                             "-o", path("b.vdag")}),
                 1, "b.vdag");
}

TEST_F(LiveEdit, ReplaysPlaceTheirBallsOnVoxels) {
  write("replay.csv",
        "SetLocation,1,2,3\nEditSphere,100,200,300,2,false\nEndFrame\n"
        "EditSphere,101,200,300,3,true\n");
  const auto run = [](const char* threads) {
    const ProcessResult result =
        run_voxdag({"edit", path("a.vdag"), "--replay", path("replay.csv"), "--json", "--threads",
                    threads, "-o", path("replayed.vdag")});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out).at("edits"), 2);
    return read_text(path("replayed.vdag"));
  };
  EXPECT_EQ(run("1"), run("2"));
  EXPECT_NE(voxels_of("replayed.vdag"), voxels_of("a.vdag"));
  write("replay.csv", "EndFrame\nEditCopy,1\n");
  expect_failure(
      run_voxdag({"edit", path("a.vdag"), "--replay", path("replay.csv"), "-o", path("none.vdag")}),
      1, "replay.csv: line 2: 'EditCopy' is no action");
}

TEST_F(LiveEdit, AMeshIsBuiltFirst) {
  const ProcessResult result =
      run_voxdag({"edit", path("cube.obj"), "-r", "16", "--do", "remove,halfspace,8,8,8,0,0,1",
                  "-o", path("half.vdag")});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const Voxel& v : voxels_of("half.vdag")) EXPECT_GE(v[2], 8);
}

TEST_F(LiveEdit, AKilledProcessLeavesTheOldFile) {
  ASSERT_EQ(
      run_voxdag({"edit", path("a.vdag"), "--do", "remove,ball,8,8,8,2", "-o", path("killed.vdag")})
          .status,
      0);
  const std::string before = read_text(path("killed.vdag"));
  // A pipe that nobody closes: the program waits for more edits.
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  Process process(voxdag_command(
      {"edit", path("a.vdag"), "--script", path("pipe"), "-o", path("killed.vdag")}));
  const int pipe = open(path("pipe").c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(pipe, 0);
  const std::string line = "remove,ball,8,8,8,3\n";
  ASSERT_EQ(::write(pipe, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  process.send_signal(SIGKILL);
  EXPECT_EQ(process.wait().status, 128 + SIGKILL);
  close(pipe);
  EXPECT_EQ(read_text(path("killed.vdag")), before);
  EXPECT_EQ(files_like("killed"), 1);
}

TEST_F(LiveEdit, AProcessThatIsKilledWhileItSavesLeavesTheOldFileOrTheNewOne) {
  const auto command = [](const char* radius, const char* out) -> std::vector<std::string> {
    return {"edit", path("a.vdag"), "--do", std::string("remove,ball,8,8,8,") + radius,
            "-o",   path(out)};
  };
  ASSERT_EQ(run_voxdag(command("3", "new.vdag")).status, 0);
  const std::string after = read_text(path("new.vdag"));
  ASSERT_EQ(run_voxdag(command("2", "killed.vdag")).status, 0);
  const std::string before = read_text(path("killed.vdag"));
  std::string left = before;
  // Until the program has saved before it is killed.
  for (int milliseconds = 0; left == before; milliseconds += 1 + milliseconds / 8) {
    Process process(voxdag_command(command("3", "killed.vdag")));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    process.send_signal(SIGKILL);
    process.wait();
    left = read_text(path("killed.vdag"));
    ASSERT_TRUE(left == before || left == after) << milliseconds << " ms";
  }
}

}  // namespace
}  // namespace voxdag::cli
