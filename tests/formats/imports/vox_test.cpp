// Scenes of MagicaVoxel against voxels that are placed one by one with matrices.
#include <algorithm>
#include <array>
#include <cmath>

#include "support/brute_svdag.hpp"
#include "support/voxel_sets.hpp"
#include "volume_files.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"

namespace voxdag {
namespace {

struct Voxel {
  Vec3i at;
  int color = 1;
};

std::string number(std::int64_t value) {
  std::string text;
  append(text, static_cast<std::uint64_t>(value), 4);
  return text;
}
std::string chunk(const std::string& id, const std::string& content) {
  return id + number(static_cast<std::int64_t>(content.size())) + number(0) + content;
}
std::string string(const std::string& text) {
  return number(static_cast<std::int64_t>(text.size())) + text;
}
std::string dictionary(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string text = number(static_cast<std::int64_t>(entries.size()));
  for (const auto& [key, value] : entries) text += string(key) + string(value);
  return text;
}
std::string hidden_if(bool is_hidden) {
  return is_hidden ? dictionary({{"_name", "x"}, {"_hidden", "1"}}) : dictionary({});
}

std::string model(Vec3i size, const std::vector<Voxel>& voxels) {
  std::string text = number(static_cast<std::int64_t>(voxels.size()));
  for (const Voxel& v : voxels)
    for (const int byte : {v.at.x, v.at.y, v.at.z, v.color}) text += static_cast<char>(byte);
  return chunk("SIZE", number(size.x) + number(size.y) + number(size.z)) + chunk("XYZI", text);
}
std::string transform(int id, int child, int rotation, Vec3i t, bool is_hidden = false,
                      int layer = -1) {
  const std::string moved =
      std::to_string(t.x) + " " + std::to_string(t.y) + " " + std::to_string(t.z);
  return chunk("nTRN", number(id) + hidden_if(is_hidden) + number(child) + number(-1) +
                           number(layer) + number(1) +
                           dictionary({{"_r", std::to_string(rotation)}, {"_t", moved}}));
}
std::string group(int id, const std::vector<int>& children, bool is_hidden = false) {
  std::string text = number(id) + hidden_if(is_hidden) + number(std::ssize(children));
  for (const int child : children) text += number(child);
  return chunk("nGRP", text);
}
std::string shape(int id, int model, bool is_hidden = false) {
  return chunk("nSHP",
               number(id) + hidden_if(is_hidden) + number(1) + number(model) + dictionary({}));
}
std::string layer(int id, bool is_hidden) {
  return chunk("LAYR", number(id) + hidden_if(is_hidden) + number(-1));
}
std::string vox(const std::string& chunks) {
  return "VOX " + number(150) + "MAIN" + number(0) +
         number(static_cast<std::int64_t>(chunks.size())) + chunks;
}

/// The identity: row 0 is x, row 1 is y.
constexpr int kNoRotation = 0 | 1 << 2;

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix matrix_of(int rotation) {
  Matrix m{};
  const int first = rotation & 3, second = rotation >> 2 & 3;
  const std::array<int, 3> columns{first, second, 3 - first - second};
  for (int row = 0; row < 3; ++row)
    m[row][columns[row]] = (rotation >> (4 + row) & 1) != 0 ? -1 : 1;
  return m;
}
Vec3d times(const Matrix& m, Vec3d v) {
  Vec3d result;
  for (int row = 0; row < 3; ++row)
    result[row] = m[row][0] * v.x + m[row][1] * v.y + m[row][2] * v.z;
  return result;
}
/// Returns where the centre of a voxel lies before the transforms of its model.
Vec3d centre_of(Vec3i voxel, Vec3i size) {
  return {voxel.x + 0.5 - std::floor(size.x / 2.0), voxel.y + 0.5 - std::floor(size.y / 2.0),
          voxel.z + 0.5 - std::floor(size.z / 2.0)};
}
Vec3i floor_of(Vec3d v) {
  return {static_cast<int>(std::floor(v.x)), static_cast<int>(std::floor(v.y)),
          static_cast<int>(std::floor(v.z))};
}
/// Moves the voxels so that the least coordinates are 0; returns by how much.
Vec3i move_to_origin(std::vector<Vec3i>& voxels) {
  Vec3i lo = voxels.at(0);
  for (const Vec3i v : voxels) lo = min(lo, v);
  for (Vec3i& v : voxels) v = v - lo;
  return lo;
}

bool is_rotation(int byte) {
  const int first = byte & 3, second = byte >> 2 & 3;
  return byte < 128 && first != 3 && second != 3 && first != second;
}

class Vox : public VolumeTest {};

TEST_F(Vox, OneModelKeepsItsVoxels) {
  for (const int levels : {2, 4})
    for (const NamedVoxels& set : voxel_sets(levels, 7)) {
      std::vector<Voxel> voxels;
      for (const Vec3i v : set.voxels) voxels.push_back({v});
      const int side = 1 << levels;
      write("m.vox", vox(model({side, side, side}, voxels)));
      const ImportResult result = import("m.vox");
      EXPECT_EQ(result.read, set.voxels.size());
      std::vector<Vec3i> moved = set.voxels;
      const Vec3i lo = moved.empty() ? Vec3i{} : move_to_origin(moved);
      EXPECT_EQ(result.grid.origin, static_cast<Vec3d>(lo));
      EXPECT_EQ(result.dag, brute_svdag(result.grid.levels, moved)) << set.name;
    }
}

TEST_F(Vox, EveryRotationOfOddAndEvenModelsIsExact) {
  int rotations = 0;
  for (int byte = 0; byte < 256; ++byte) {
    const Vec3i size{3, 4, 5}, t{-7, 2, 11};
    const std::vector<Voxel> voxels = {
        {{0, 0, 0}}, {{2, 0, 0}}, {{0, 3, 0}}, {{2, 3, 4}}, {{1, 1, 4}}};
    write("m.vox", vox(model(size, voxels) + transform(0, 1, byte, t) + shape(1, 0)));
    if (!is_rotation(byte)) {
      EXPECT_TRUE(has(error_of([&] { open("m.vox"); }), "is not a permutation of the axes"))
          << byte;
      continue;
    }
    ++rotations;
    std::vector<Vec3i> expected;
    for (const Voxel& v : voxels)
      expected.push_back(
          floor_of(times(matrix_of(byte), centre_of(v.at, size)) + static_cast<Vec3d>(t)));
    const Vec3i lo = move_to_origin(expected);
    EXPECT_EQ(read("m.vox").voxels, expected) << byte;
    EXPECT_EQ(open("m.vox")->grid()->origin, static_cast<Vec3d>(lo));
  }
  EXPECT_EQ(rotations, 48);
}

TEST_F(Vox, TransformsOfGroupsAreMultiplied) {
  std::mt19937 rng(5);
  for (int run = 0; run < 200; ++run) {
    const auto any_rotation = [&] {
      int byte = 0;
      do byte = static_cast<int>(rng() % 128);
      while (!is_rotation(byte));
      return byte;
    };
    const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
    const auto any_move = [&] { return Vec3i{below(20) - 10, below(20) - 10, below(20) - 10}; };
    const int outer = any_rotation(), inner = any_rotation();
    const Vec3i outer_t = any_move(), inner_t = any_move(),
                size{1 + below(6), 1 + below(6), 1 + below(6)};
    const Vec3i voxel{below(size.x), below(size.y), below(size.z)};
    // A second voxel, which nothing moves, shows the place of the first one.
    write("m.vox", vox(model({1, 1, 1}, {{{0, 0, 0}}}) + model(size, {{voxel}}) + group(0, {1, 2}) +
                       shape(1, 0) + transform(2, 3, outer, outer_t) + group(3, {4}) +
                       transform(4, 5, inner, inner_t) + shape(5, 1)));
    const Vec3d placed = times(matrix_of(outer), times(matrix_of(inner), centre_of(voxel, size)) +
                                                     static_cast<Vec3d>(inner_t)) +
                         static_cast<Vec3d>(outer_t);
    std::vector<Vec3i> expected = {{0, 0, 0}, floor_of(placed)};
    move_to_origin(expected);
    EXPECT_EQ(read("m.vox").voxels, expected);
  }
}

TEST_F(Vox, HiddenNodesAndLayersAreLeftOut) {
  const auto count = [&](bool root, bool inner, bool leaf, bool layer_2) {
    write("m.vox", vox(model({1, 1, 1}, {{{0, 0, 0}}}) + transform(0, 1, kNoRotation, {}) +
                       group(1, {2, 4}, root) + transform(2, 3, kNoRotation, {1, 0, 0}, inner, 2) +
                       shape(3, 0, leaf) + transform(4, 5, kNoRotation, {}, false, 7) +
                       shape(5, 0) + layer(2, layer_2) + layer(3, true)));
    return read("m.vox").voxels.size();
  };
  EXPECT_EQ(count(false, false, false, false), 2u);
  EXPECT_EQ(count(true, false, false, false), 0u);
  EXPECT_EQ(count(false, true, false, false), 1u);
  EXPECT_EQ(count(false, false, true, false), 1u);
  EXPECT_EQ(count(false, false, false, true), 1u);
}

TEST_F(Vox, ColorsAreThoseOfThePalette) {
  const std::string voxels = model({6, 1, 1}, {{{0, 0, 0}, 1},
                                               {{1, 0, 0}, 2},
                                               {{2, 0, 0}, 0},
                                               {{3, 0, 0}, 215},
                                               {{4, 0, 0}, 216},
                                               {{5, 0, 0}, 255}});
  write("m.vox", vox(voxels));
  EXPECT_TRUE(open("m.vox")->has_colors());
  EXPECT_EQ(
      read("m.vox").colors,
      (std::vector<Rgb8>{{255, 255, 255}, {255, 255, 204}, {0, 0, 51}, {238, 0, 0}, {17, 17, 17}}));
  EXPECT_EQ(read("m.vox").voxels.size(), 5u) << "index 0 is an empty voxel";

  std::string palette, order;
  for (int i = 0; i < 256; ++i) {
    for (const int byte : {i, 255 - i, 7, 255}) palette += static_cast<char>(byte);
    order += static_cast<char>(255 - i);
  }
  // IMAP says where MagicaVoxel shows a colour, and changes none.
  write("m.vox", vox(voxels + chunk("RGBA", palette) + chunk("IMAP", order)));
  EXPECT_EQ(read("m.vox").colors,
            (std::vector<Rgb8>{{0, 255, 7}, {1, 254, 7}, {214, 41, 7}, {215, 40, 7}, {254, 1, 7}}));
}

TEST_F(Vox, FilesWithoutASceneHaveAllModelsAtTheOrigin) {
  const std::string two = model({3, 3, 3}, {{{1, 2, 2}}}) + model({6, 2, 2}, {{{4, 1, 1}}});
  write("m.vox", vox(chunk("PACK", number(2)) + two));
  EXPECT_EQ(read("m.vox").voxels, (std::vector<Vec3i>{{0, 1, 1}, {3, 0, 0}}));
  EXPECT_EQ(open("m.vox")->grid()->origin, (Vec3d{1, 1, 1}));
  EXPECT_EQ(open("m.vox")->warnings().size(), 1u);
  EXPECT_TRUE(has(error_of_bytes("m.vox", vox(chunk("PACK", number(3)) + two)),
                  "has 2 models, but the PACK chunk says 3"));
}

TEST_F(Vox, PalettesMayBeShort) {
  const std::string voxels = model({2, 1, 1}, {{{0, 0, 0}, 1}, {{1, 0, 0}, 2}});
  write("m.vox", vox(voxels + chunk("RGBA", std::string("\377\0\0\377\0\0\377\377", 8))));
  EXPECT_EQ(read("m.vox").colors, (std::vector<Rgb8>{{255, 0, 0}, {0, 0, 255}}));
  EXPECT_TRUE(has(error_of_bytes("m.vox", vox(voxels + chunk("RGBA", "\1\2\3"))), "truncated"));
}

TEST_F(Vox, VoxelsOutsideOfTheirModelAreLeftOut) {
  write("m.vox",
        vox(model({2, 1, 1}, {{{0, 0, 0}, 1}, {{2, 0, 0}, 2}, {{1, 0, 0}, 3}, {{9, 9, 9}}})));
  EXPECT_EQ(read("m.vox").voxels, (std::vector<Vec3i>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_TRUE(
      has(open("m.vox")->warnings().at(0), "voxels outside of their models are left out: 2"));
}

TEST_F(Vox, TheChunksOfAModelMayLieInPack) {
  const std::string one = model({1, 1, 1}, {{{0, 0, 0}}});
  const std::string inside = "PACK" + number(4) + number(std::ssize(one)) + number(1) + one;
  const std::string wrong = "PACK" + number(4) + number(1'000'000) + number(1) + one;
  for (const std::string& chunks : {inside, wrong}) {
    write("m.vox", vox(chunks));
    EXPECT_EQ(read("m.vox").voxels.size(), 1u);
  }
  write("m.vox", vox(one) + "more");
  EXPECT_TRUE(has(open("m.vox")->warnings().at(0), "bytes after the MAIN chunk are left out: 4"));
}

TEST_F(Vox, OfSeveralModelsAtAPlaceTheLastOneIsSeen) {
  const auto colors = [&](int first, int second, const std::string& order) {
    write("m.vox", vox(model({2, 1, 1}, {{{0, 0, 0}, first}, {{1, 0, 0}, first}}) +
                       model({2, 1, 1}, {{{0, 0, 0}, second}}) + transform(0, 1, kNoRotation, {}) +
                       order + shape(2, 0) + shape(3, 1)));
    ImportOptions options;
    options.folder = dir_.path();
    const ImportResult result = import_voxels(*open("m.vox"), options);
    EXPECT_EQ(result.dag, brute_svdag(2, {{0, 0, 0}, {1, 0, 0}}));
    PageReader pages(result.attributes.colors.view());
    std::vector<Value8> seen;
    for (const Vec3i v : {Vec3i{0, 0, 0}, Vec3i{1, 0, 0}}) {
      std::uint64_t number = 0;
      EXPECT_TRUE(
          find_cell_number(result.dag.view(), result.attributes.index.view(), v, 2, number));
      seen.push_back(pages.value(number));
    }
    return seen;
  };
  const Value8 white{255, 255, 255}, red{238, 0, 0};
  EXPECT_EQ(colors(1, 216, group(1, {2, 3})), (std::vector<Value8>{red, white}));
  EXPECT_EQ(colors(1, 216, group(1, {3, 2})), (std::vector<Value8>{white, white}));
  EXPECT_EQ(colors(216, 1, group(1, {2, 3})), (std::vector<Value8>{white, red}));
}

TEST_F(Vox, OnlyTheFirstFramesCount) {
  const std::string frames = number(0) + dictionary({}) + number(1) + number(-1) + number(-1) +
                             number(2) + dictionary({{"_t", "5 0 0"}, {"_f", "0"}}) +
                             dictionary({{"_t", "9 0 0"}, {"_f", "10"}});
  const std::string models = number(1) + dictionary({}) + number(2) + number(1) +
                             dictionary({{"_f", "0"}}) + number(0) + dictionary({{"_f", "3"}});
  write("m.vox", vox(model({1, 1, 1}, {{{0, 0, 0}}}) + model({2, 1, 1}, {{{1, 0, 0}}}) +
                     chunk("nTRN", frames) + chunk("nSHP", models)));
  EXPECT_EQ(open("m.vox")->grid()->origin, (Vec3d{5, 0, 0}));
}

std::string small_scene() {
  return vox(model({3, 2, 4}, {{{0, 1, 2}, 3}, {{2, 1, 3}, 9}}) + transform(0, 1, kNoRotation, {}) +
             group(1, {2}) + transform(2, 3, 0 | 2 << 2 | 1 << 5, {4, 5, -6}) + shape(3, 0) +
             layer(0, false));
}

TEST_F(Vox, EveryTruncatedFileIsRefused) { expect_no_prefix_is_read("m.vox", small_scene()); }

TEST_F(Vox, EveryFlippedBitIsRefusedOrSafe) {
  EXPECT_GT(flip_every_bit("m.vox", small_scene()), 1000);
}

TEST_F(Vox, DamagedScenesAreRefused) {
  const std::string one = model({1, 1, 1}, {{{0, 0, 0}}});
  const auto error = [&](const std::string& chunks) {
    return error_of_bytes("m.vox", vox(chunks));
  };
  EXPECT_TRUE(has(error(one + transform(0, 0, kNoRotation, {})), "a node inside itself"));
  EXPECT_TRUE(has(error(one + group(0, {1}) + group(1, {2}) + group(2, {1})), "inside itself"));
  EXPECT_TRUE(has(error(one + group(0, {5})), "there is no node 5"));
  EXPECT_TRUE(has(error(one + group(1, {})), "the scene has no node 0"));
  EXPECT_TRUE(has(error(one + shape(0, 1)), "there is no model 1"));
  EXPECT_TRUE(has(error(one + shape(0, -1)), "there is no model -1"));
  EXPECT_TRUE(has(error(one + shape(0, 0) + shape(0, 0)), "node 0 is there twice"));
  EXPECT_TRUE(has(error(model({0, 1, 1}, {})), "the model is 0 voxels long"));
  EXPECT_TRUE(has(error(model({257, 1, 1}, {})), "the model is 257 voxels long"));
  EXPECT_EQ(error(model({1, 1, 1}, {{{1, 0, 0}}})), "no error");
  EXPECT_TRUE(has(error(chunk("XYZI", number(0))), "has no SIZE chunk"));
  EXPECT_TRUE(has(error(chunk("SIZE", number(1) + number(1) + number(1))), "has no XYZI chunk"));
  EXPECT_TRUE(has(error(chunk("SIZE", number(1) + number(1) + number(1)) +
                        chunk("XYZI", number(1'000'000'000))),
                  "has 1000000000 voxels, more than fit"));
  EXPECT_TRUE(has(error(one + chunk("nGRP", number(0) + number(-1))), "4294967295 entries"));
  EXPECT_EQ(error_of_bytes("m.vox", vox(one) + "x"), "no error");
  EXPECT_TRUE(has(error_of_bytes("m.vox", "RIFF1234"), "is not a .vox file"));
  const auto frame = [&](const std::string& key, const std::string& value) {
    return error(one + chunk("nTRN", number(0) + dictionary({}) + number(1) + number(-1) +
                                         number(-1) + number(1) + dictionary({{key, value}})));
  };
  EXPECT_TRUE(has(frame("_t", "1 2"), "is not three whole numbers"));
  EXPECT_TRUE(has(frame("_t", "1 2 3 4"), "is not three whole numbers"));
  EXPECT_TRUE(has(frame("_t", "1 2 99999999999"), "is not three whole numbers"));
  EXPECT_TRUE(has(frame("_r", "x"), "the rotation 'x'"));
}

TEST_F(Vox, HugeScenesAreRefused) {
  const std::string one = model({1, 1, 1}, {{{0, 0, 0}}});
  // Each group has the next one twice: 2^30 paths.
  std::string doubling;
  for (int i = 0; i < 30; ++i) doubling += group(i, {i + 1, i + 1});
  EXPECT_TRUE(
      has(error_of_bytes("m.vox", vox(one + doubling + shape(30, 0))), "more than 1048576 models"));
  EXPECT_TRUE(has(error_of_bytes("m.vox", vox(one + doubling + group(30, {}))),
                  "repeats its groups more than 4194304 times"));
  const auto apart = [&](int distance) {
    return error_of_bytes("m.vox", vox(one + group(0, {1, 2}) + shape(1, 0) +
                                       transform(2, 1, kNoRotation, {distance, 0, 0})));
  };
  EXPECT_EQ(apart((1 << 20) - 1), "no error");
  EXPECT_TRUE(has(apart(1 << 20), "the scene is 1048577 voxels long"));
  EXPECT_TRUE(has(apart(2147483647), "farther than 1073741823 voxels"));
}

}  // namespace
}  // namespace voxdag
