/// The commands that change the voxels of DAGs, against sets of exported voxels.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "sponge.hpp"
#include "voxdag/algebra/attributes/number_finder.hpp"
#include "voxdag/algebra/attributes/stored_reader.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag::cli {
namespace {

using Voxel = std::array<int, 3>;
using Voxels = std::set<Voxel>;

class Edit : public Sponge {
 protected:
  static void SetUpTestSuite() {
    Sponge::SetUpTestSuite();
    ASSERT_EQ(run_voxdag({"scene", "sponge", "--size", "1", "-o", path("other.ply")}).status, 0);
    for (const auto& [mesh, file] : {std::pair{"sponge.ply", "a.vdag"}, {"other.ply", "b.vdag"}})
      ASSERT_EQ(run_voxdag({"build", path(mesh), "-r", "32", "--bounds", "0,0,0,0.6,0.6,0.6", "-o",
                            path(file)})
                    .status,
                0);
  }

  /// Runs the command, which must succeed and write a valid file.
  static std::string run(std::vector<std::string> words, const std::string& output) {
    words.insert(words.end(), {"-o", path(output)});
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(run_voxdag({"verify", path(output)}).status, 0) << words[0];
    return result.out;
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
  template <class Move>
  static Voxels moved(const Voxels& voxels, const Move& move) {
    Voxels result;
    for (const Voxel& v : voxels) result.insert(move(v));
    return result;
  }
};

TEST_F(Edit, CombineMakesTheSetsOfItsName) {
  const Voxels a = voxels_of("a.vdag"), b = voxels_of("b.vdag");
  ASSERT_GT(a.size(), 1000u);
  ASSERT_NE(a, b);
  const auto expect = [&](const char* operation, const auto& make) {
    Voxels expected;
    make(a.begin(), a.end(), b.begin(), b.end(), std::inserter(expected, expected.end()));
    run({"combine", path("a.vdag"), path("b.vdag"), operation}, "c.vdag");
    EXPECT_EQ(voxels_of("c.vdag"), expected) << operation;
  };
  using I = Voxels::const_iterator;
  using Out = std::insert_iterator<Voxels>;
  expect("--union", std::set_union<I, I, Out>);
  expect("--intersect", std::set_intersection<I, I, Out>);
  expect("--subtract", std::set_difference<I, I, Out>);
  expect("--xor", std::set_symmetric_difference<I, I, Out>);
}

TEST_F(Edit, CombineAlignsGridsThatCoincide) {
  run({"shift", path("a.vdag"), "--by", "40,3,5", "--levels", "7"}, "far.vdag");
  const Voxels a = voxels_of("a.vdag"), far = voxels_of("far.vdag");
  EXPECT_EQ(far, moved(a, [](const Voxel& v) { return Voxel{v[0] + 40, v[1] + 3, v[2] + 5}; }));
  Voxels both = a;
  both.insert(far.begin(), far.end());
  run({"combine", path("a.vdag"), path("far.vdag"), "--union"}, "both.vdag");
  EXPECT_EQ(voxels_of("both.vdag"), both);
  // A difference keeps the grid of the first file.
  run({"combine", path("a.vdag"), path("both.vdag"), "--intersect"}, "agaa.vdag");
  EXPECT_EQ(voxels_of("agaa.vdag"), a);
  const ProcessResult info = run_voxdag({"info", path("agaa.vdag"), "--json"});
  const nlohmann::json json = nlohmann::json::parse(info.out);
  EXPECT_EQ(json.at("resolution"), 32);
  EXPECT_EQ(json.at("build").at("edits"), "intersection with both.vdag");
}

TEST_F(Edit, CombineRefusesGridsThatDoNotCoincide) {
  ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "64", "--bounds", "0,0,0,0.6,0.6,0.6",
                        "-o", path("fine.vdag")})
                .status,
            0);
  expect_failure(run_voxdag({"combine", path("a.vdag"), path("fine.vdag"), "--union", "-o",
                             path("none.vdag")}),
                 1, "the grids do not align: their voxels have sides of ");
  EXPECT_EQ(files_like("none"), 0);
  expect_failure(run_voxdag({"combine", path("a.vdag"), path("b.vdag"), "-o", path("none.vdag")}),
                 2, "one of --union, --intersect, --subtract and --xor is required");
  expect_failure(
      run_voxdag({"combine", path("a.vdag"), path("b.vdag"), "--union", "-o", path("b.vdag")}), 2,
      "--output");
}

TEST_F(Edit, DiffCountsWhatDiffers) {
  const Voxels a = voxels_of("a.vdag"), b = voxels_of("b.vdag");
  Voxels only_a, only_b, differing;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(only_a, only_a.end()));
  std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::inserter(only_b, only_b.end()));
  differing = only_a;
  differing.insert(only_b.begin(), only_b.end());
  const ProcessResult result = run_voxdag(
      {"diff", path("a.vdag"), path("b.vdag"), "--json", "-o", path("d.vdag"), "--compact"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("only_in_first"), only_a.size());
  EXPECT_EQ(json.at("only_in_second"), only_b.size());
  EXPECT_EQ(json.at("in_both"), a.size() - only_a.size());
  EXPECT_EQ(json.at("differing"), differing.size());
  EXPECT_EQ(voxels_of("d.vdag"), differing);
  const ProcessResult same = run_voxdag({"diff", path("a.vdag"), path("a.vdag")});
  EXPECT_NE(same.out.find(": 0 voxels"), std::string::npos) << same.out;
}

TEST_F(Edit, CropShiftMirrorAndRotateMoveVoxels) {
  const Voxels a = voxels_of("a.vdag");
  run({"crop", path("a.vdag"), "--window", "3,0,5,20,17,32"}, "c.vdag");
  Voxels inside;
  for (const Voxel& v : a)
    if (v[0] >= 3 && v[0] < 20 && v[1] < 17 && v[2] >= 5) inside.insert(v);
  EXPECT_EQ(voxels_of("c.vdag"), inside);

  run({"shift", path("c.vdag"), "--by", "-3,1,0"}, "s.vdag");
  EXPECT_EQ(voxels_of("s.vdag"), moved(inside, [](const Voxel& v) {
              return Voxel{v[0] - 3, v[1] + 1, v[2]};
            }));
  expect_failure(run_voxdag({"shift", path("c.vdag"), "--by", "-4,0,0", "-o", path("none.vdag")}),
                 1,
                 "voxels would leave the grid: --levels makes it larger, --drop-outside leaves "
                 "them out");
  EXPECT_EQ(files_like("none"), 0);

  run({"mirror", path("c.vdag"), "--axis", "y"}, "m.vdag");
  EXPECT_EQ(voxels_of("m.vdag"), moved(inside, [](const Voxel& v) {
              return Voxel{v[0], 31 - v[1], v[2]};
            }));
  run({"rotate", path("c.vdag"), "--axis", "z"}, "r.vdag");
  EXPECT_EQ(voxels_of("r.vdag"), moved(inside, [](const Voxel& v) {
              return Voxel{31 - v[1], v[0], v[2]};
            }));
  run({"rotate", path("r.vdag"), "--axis", "z", "--turns", "-1"}, "back.vdag");
  EXPECT_EQ(voxels_of("back.vdag"), inside);
}

TEST_F(Edit, DilateAndErodeFollowTheNeighbours) {
  run({"crop", path("a.vdag"), "--window", "9,9,9,14,23,11"}, "few.vdag");
  const Voxels few = voxels_of("few.vdag");
  ASSERT_FALSE(few.empty());
  Voxels near6, near26;
  for (const Voxel& v : few)
    for (int z = -2; z <= 2; ++z)
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
          near26.insert({v[0] + x, v[1] + y, v[2] + z});
          if (std::abs(x) + std::abs(y) + std::abs(z) <= 2)
            near6.insert({v[0] + x, v[1] + y, v[2] + z});
        }
  run({"dilate", path("few.vdag"), "--steps", "2"}, "d26.vdag");
  EXPECT_EQ(voxels_of("d26.vdag"), near26);
  run({"dilate", path("few.vdag"), "--steps", "2", "--neighbours", "6"}, "d6.vdag");
  EXPECT_EQ(voxels_of("d6.vdag"), near6);
  run({"erode", path("d26.vdag"), "--steps", "2"}, "e.vdag");
  const Voxels closed = voxels_of("e.vdag");
  EXPECT_TRUE(std::includes(closed.begin(), closed.end(), few.begin(), few.end()));
  const ProcessResult none = run_voxdag({"erode", path("few.vdag"), "-o", path("empty.vdag")});
  EXPECT_EQ(none.status, 0);
  EXPECT_NE(none.err.find("voxdag: "), std::string::npos) << "it warns that no voxel is left";
}

TEST_F(Edit, ComponentsAreCountedAndTheLargeOnesKept) {
  // A shell around an empty cube, and two voxels far away that share an edge.
  const Voxel v = *voxels_of("a.vdag").begin();
  run({"crop", path("a.vdag"), "--window",
       fmt::format("{},{},{},{},{},{}", v[0], v[1], v[2], v[0] + 1, v[1] + 1, v[2] + 1)},
      "any.vdag");
  run({"shift", path("any.vdag"), "--by", fmt::format("{},{},{}", 4 - v[0], 4 - v[1], 4 - v[2])},
      "one.vdag");
  ASSERT_EQ(voxels_of("one.vdag"), (Voxels{{4, 4, 4}}));
  run({"dilate", path("one.vdag"), "--steps", "3"}, "cube.vdag");
  run({"erode", path("cube.vdag")}, "inner.vdag");
  run({"combine", path("cube.vdag"), path("inner.vdag"), "--subtract"}, "shell.vdag");
  run({"shift", path("one.vdag"), "--by", "20,20,20"}, "far.vdag");
  run({"shift", path("one.vdag"), "--by", "21,21,20"}, "farther.vdag");
  run({"combine", path("shell.vdag"), path("far.vdag"), "--union"}, "two.vdag");
  run({"combine", path("two.vdag"), path("farther.vdag"), "--union"}, "all.vdag");
  const auto sizes = [](const char* neighbours) {
    const ProcessResult result =
        run_voxdag({"components", path("all.vdag"), "--neighbours", neighbours, "--json"});
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const std::size_t shell = 7 * 7 * 7 - 5 * 5 * 5;
  EXPECT_EQ(sizes("26").at("components"), 2);
  EXPECT_EQ(sizes("26").at("sizes"),
            nlohmann::json::parse("[{\"voxels\": " + std::to_string(shell) +
                                  ", \"count\": 1}, {\"voxels\": 2, \"count\": 1}]"));
  EXPECT_EQ(sizes("6").at("components"), 3);
  const std::string text = run({"components", path("all.vdag"), "--largest"}, "largest.vdag");
  EXPECT_NE(text.find(": 2 components of 26 neighbours"), std::string::npos) << text;
  EXPECT_EQ(voxels_of("largest.vdag"), voxels_of("shell.vdag"));
  run({"components", path("all.vdag"), "--at-least", "2"}, "kept.vdag");
  EXPECT_EQ(voxels_of("kept.vdag"), voxels_of("all.vdag"));
  run({"components", path("all.vdag"), "--at-least", "2", "--neighbours", "6"}, "kept.vdag");
  EXPECT_EQ(voxels_of("kept.vdag"), voxels_of("shell.vdag"));
  run({"fill", path("shell.vdag")}, "filled.vdag");
  EXPECT_EQ(voxels_of("filled.vdag"), voxels_of("cube.vdag"));
  expect_failure(run_voxdag({"components", path("all.vdag"), "-o", path("none.vdag")}), 2,
                 "needs --largest or --at-least");
  expect_failure(run_voxdag({"components", path("all.vdag"), "--largest"}), 2, "--output");
  expect_failure(run_voxdag({"components", path("all.vdag"), "--neighbours", "18"}), 2,
                 "must be 6 or 26");
}

TEST_F(Edit, EitherFormOnAnyNumberOfThreadsGivesTheSameBytes) {
  ASSERT_EQ(run_voxdag({"convert", path("a.vdag"), "--compact", "-o", path("k.vdag")}).status, 0);
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"dilate"}, {"fill"}, {"rotate", "--axis", "x"}, {"shift", "--by", "0,0,0"}}) {
    const auto with = [&](const char* file, const char* threads) {
      std::vector<std::string> all = words;
      all.insert(all.begin() + 1, path(file));
      all.insert(all.end(), {"--plain", "--threads", threads});
      run(all, "same.vdag");
      return read_text(path("same.vdag"));
    };
    EXPECT_EQ(with("a.vdag", "1"), with("k.vdag", "3")) << words[0];
  }
}

TEST_F(Edit, FilesNameTheProgramWithoutItsCommit) {
  run({"combine", path("a.vdag"), path("b.vdag"), "--union"}, "named.vdag");
  ASSERT_EQ(run_voxdag({"export", path("a.vdag"), "-o", path("named.npy"), "-q"}).status, 0);
  run({"import", path("named.npy")}, "imported.vdag");
  for (const char* file : {"a.vdag", "named.vdag", "imported.vdag"})
    EXPECT_NE(read_text(path(file)).find("\"program\":\"voxdag " VOXDAG_VERSION "\""),
              std::string::npos)
        << file;
}

/// The edits of files with colours, normals and material ids.
class ColoredEdit : public Edit {
 protected:
  static void SetUpTestSuite() {
    Edit::SetUpTestSuite();
    ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "32", "--bounds", "0,0,0,0.6,0.6,0.6",
                          "--color", "--normal", "--ids", "file", "-o", path("col.vdag")})
                  .status,
              0);
  }

  using Values = std::map<Voxel, CellValues>;

  static Values values_of(const std::string& file) {
    const DagModel model(path(file));
    NumberFinder finder(model.view(), model.attributes().index);
    StoredReader reader({model.attributes(), {}});
    Values values;
    for_each_voxel(model.view(), whole_grid(model.grid().levels), [&](Vec3i v) {
      std::uint64_t number = 0;
      EXPECT_TRUE(finder.find(v, number));
      values[{v.x, v.y, v.z}] = reader.values(number);
    });
    return values;
  }
};

TEST_F(ColoredEdit, MovedAndCroppedFilesHaveTheValuesOfTheOriginal) {
  const Values all = values_of("col.vdag");
  ASSERT_GT(all.size(), 1000u);
  run({"shift", path("col.vdag"), "--by", "5,3,-1", "--levels", "6", "--drop-outside"},
      "moved.vdag");
  run({"crop", path("moved.vdag"), "--window", "5,3,0,25,27,14"}, "part.vdag");
  Values expected;
  for (const auto& [v, values] : all)
    if (v[0] < 20 && v[1] < 24 && v[2] >= 1 && v[2] < 15)
      expected[{v[0] + 5, v[1] + 3, v[2] - 1}] = values;
  EXPECT_TRUE(values_of("part.vdag") == expected);
}

TEST_F(ColoredEdit, AttributesAreDroppedOnlyOnRequest) {
  run({"dilate", path("col.vdag")}, "grown.vdag");
  run({"dilate", path("col.vdag"), "--drop-attributes"}, "grey.vdag");
  const DagModel grown(path("grown.vdag")), grey(path("grey.vdag"));
  EXPECT_FALSE(grown.attributes().is_empty());
  EXPECT_TRUE(grey.attributes().is_empty());
  const SvdagView a = grown.view(), b = grey.view();
  EXPECT_TRUE(std::equal(a.nodes, a.nodes + a.node_words(), b.nodes, b.nodes + b.node_words()));
  EXPECT_TRUE(std::equal(a.leaf_blocks, a.leaf_blocks + a.leaf_block_count, b.leaf_blocks,
                         b.leaf_blocks + b.leaf_block_count));
}

TEST_F(ColoredEdit, NewVoxelsTakeTheGivenValues) {
  const Values old = values_of("col.vdag");
  run({"dilate", path("col.vdag"), "--color", "1,20,200", "--material", "0"}, "given.vdag");
  std::size_t count = 0;
  for (const auto& [v, values] : values_of("given.vdag")) {
    const auto before = old.find(v);
    const Value8 expected = before == old.end() ? Value8{1, 20, 200} : before->second.color;
    ASSERT_EQ(values.color, expected);
    if (before == old.end()) ++count;
  }
  EXPECT_GT(count, 100u);
  expect_failure(run_voxdag({"fill", path("col.vdag"), "--material", "1", "-o", path("none.vdag")}),
                 1, "new voxels cannot have material 1");
  expect_failure(run_voxdag({"fill", path("a.vdag"), "--color", "1,2,3", "-o", path("none.vdag")}),
                 1, "a colour of new voxels needs colours");
  expect_failure(run_voxdag({"fill", path("col.vdag"), "--color", "1,2,3", "--drop-attributes",
                             "-o", path("none.vdag")}),
                 2, "no effect");
  EXPECT_EQ(files_like("none"), 0);
}

TEST_F(ColoredEdit, CombineSaysWhichFileHasNoValues) {
  const ProcessResult result =
      run_voxdag({"combine", path("b.vdag"), path("col.vdag"), "--union", "-o", path("both.vdag")});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(
      result.err.find("b.vdag has no colours, normals, material ids: its voxels count as new"),
      std::string::npos)
      << result.err;
  const Values old = values_of("col.vdag"), all = values_of("both.vdag");
  for (const auto& [v, values] : old) ASSERT_EQ(all.at(v), values);
}

TEST_F(Edit, AMemoryLimitIsKeptOrRefused) {
  expect_failure(run_voxdag({"dilate", path("a.vdag"), "--memory", "1M", "-o", path("none.vdag")}),
                 1, "the memory limit of 1 MiB is too small");
  EXPECT_EQ(files_like("none"), 0);
}

TEST_F(Edit, DiffFindsTheShiftThatMakesBothEqual) {
  run({"crop", path("a.vdag"), "--window", "0,0,0,20,20,20"}, "part.vdag");
  run({"shift", path("part.vdag"), "--by", "3,0,2"}, "moved.vdag");
  const auto diff = [](const std::string& a, const std::string& b) {
    return run_voxdag({"diff", path(a), path(b)}).out;
  };
  EXPECT_NE(diff("part.vdag", "moved.vdag").find("voxdag shift --by 3,0,2\n"), std::string::npos);
  EXPECT_NE(diff("moved.vdag", "part.vdag").find("voxdag shift --by -3,0,-2\n"), std::string::npos);
  EXPECT_EQ(diff("part.vdag", "part.vdag").find("shift"), std::string::npos);
  EXPECT_EQ(diff("a.vdag", "b.vdag").find("shift"), std::string::npos);
  const auto json = nlohmann::json::parse(
      run_voxdag({"diff", path("part.vdag"), path("moved.vdag"), "--json"}).out);
  EXPECT_EQ(json.at("equal_when_shifted"), (std::vector<int>{3, 0, 2}));
}

TEST_F(Edit, GridsThatDoNotAlignAreToldHowTheyWould) {
  const auto build = [](const std::string& file, const std::vector<std::string>& options) {
    std::vector<std::string> words = {"build", path("sponge.ply"), "-o", path(file)};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(run_voxdag(words).status, 0);
  };
  build("own.vdag", {"-r", "20"});
  const ProcessResult apart = run_voxdag({"diff", path("a.vdag"), path("own.vdag")});
  expect_failure(apart, 1, "voxdag build --grid-of " + path("a.vdag"));
  build("same.vdag", {"--grid-of", path("a.vdag")});
  const auto warning_of = [](const std::string& by) {
    return run_voxdag({"build", path("sponge.ply"), "--grid-of", path("a.vdag"), "--translate", by,
                       "-o", path("moved.vdag")})
        .err;
  };
  EXPECT_EQ(warning_of("0,0,0"), "");
  const std::string part = warning_of("-0.5,0,0"), none = warning_of("-99,0,0");
  EXPECT_NE(part.find("out of the grid of " + path("a.vdag")), part.npos) << part;
  EXPECT_EQ(none.find("out of the grid"), none.npos) << none;
  EXPECT_NE(none.find("no voxels"), none.npos) << none;
  EXPECT_NE(run_voxdag({"diff", path("a.vdag"), path("same.vdag")})
                .out.find("only in " + path("a.vdag") + ": 0 voxels\nonly in " + path("same.vdag") +
                          ": 0 voxels\n"),
            std::string::npos);
  build("0.vdag", {"--voxel-size", "0.02", "--origin", "0,0,0"});
  // The mesh and its grid move by a part of a voxel.
  build("1.vdag", {"--voxel-size", "0.02", "--origin", "0.005,0,0", "--translate", "0.005,0,0"});
  expect_failure(run_voxdag({"diff", path("0.vdag"), path("1.vdag")}), 1,
                 "equal if the first file moves by 0.005,0,0");
  expect_failure(run_voxdag({"build", path("sponge.ply"), "-r", "8", "--grid-of", path("a.vdag")}),
                 2, "--grid-of");
}

TEST_F(Edit, TheSummaryAlsoComesAsJson) {
  const ProcessResult result = run_voxdag(
      {"combine", path("a.vdag"), path("b.vdag"), "--union", "-o", path("u.vdag"), "--json"});
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("files"), std::vector<std::string>{path("u.vdag")});
  EXPECT_EQ(json.at("bytes"), std::filesystem::file_size(path("u.vdag")));
  EXPECT_EQ(json.at("voxels"), voxels_of("u.vdag").size());
  EXPECT_GE(json.at("seconds"), 0);
}

}  // namespace
}  // namespace voxdag::cli
