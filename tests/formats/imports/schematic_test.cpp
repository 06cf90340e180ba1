// Blocks of Minecraft, which the tests write tag by tag, against the blocks that they hold.
#include <bit>
#include <map>

#include "formats/exports/read_back.hpp"
#include "support/brute_svdag.hpp"
#include "support/random_bits.hpp"
#include "volume_files.hpp"
#include "voxdag/formats/exports/grids/block_palette.hpp"
#include "voxdag/formats/exports/grids/export_schem.hpp"
#include "voxdag/formats/imports/moved_source.hpp"

namespace voxdag {
namespace {

std::string nbt_number(std::int64_t value, int bytes) {
  std::string text;
  append(text, static_cast<std::uint64_t>(value), bytes, true);
  return text;
}
std::string nbt_text(const std::string& text) { return nbt_number(std::ssize(text), 2) + text; }
std::string nbt_tag(int type, const std::string& name, const std::string& payload) {
  return static_cast<char>(type) + nbt_text(name) + payload;
}
std::string nbt_short(const std::string& name, std::int64_t value) {
  return nbt_tag(2, name, nbt_number(value, 2));
}
std::string nbt_int(const std::string& name, std::int64_t value) {
  return nbt_tag(3, name, nbt_number(value, 4));
}
std::string nbt_bytes(const std::string& name, const std::string& bytes) {
  return nbt_tag(7, name, nbt_number(std::ssize(bytes), 4) + bytes);
}
std::string nbt_compound(const std::string& name, const std::string& entries) {
  return nbt_tag(10, name, entries + '\0');
}
/// A list of payloads of one type.
std::string nbt_list(const std::string& name, int type, const std::vector<std::string>& items) {
  std::string payload = static_cast<char>(type) + nbt_number(std::ssize(items), 4);
  for (const std::string& item : items) payload += item;
  return nbt_tag(9, name, payload);
}
std::string nbt_triple(const std::string& name, Vec3i v) {
  return nbt_compound(name, nbt_int("x", v.x) + nbt_int("y", v.y) + nbt_int("z", v.z));
}

/// Blocks in the order of the formats, as numbers of a palette whose number 0 is air.
struct TestBlocks {
  Vec3i size;
  std::vector<int> numbers;

  TestBlocks(Vec3i sides, int palette, std::uint32_t seed) : size(sides) {
    Random random(seed);
    for (int i = 0; i < size.x * size.y * size.z; ++i)
      numbers.push_back(random() % 2 == 0 ? 0 : static_cast<int>(random() % palette));
  }
  /// Returns the voxels in the order of the file, and the number of each.
  std::vector<std::pair<Vec3i, int>> voxels() const {
    std::vector<std::pair<Vec3i, int>> set;
    std::size_t i = 0;
    for (int y = 0; y < size.y; ++y)
      for (int z = 0; z < size.z; ++z)
        for (int x = 0; x < size.x; ++x, ++i)
          if (numbers[i] != 0) set.push_back({{x, y, z}, numbers[i]});
    return set;
  }
  std::string varints() const {
    std::string bytes;
    for (int number : numbers) {
      for (; number >= 128; number >>= 7) bytes += static_cast<char>(128 | (number & 127));
      bytes += static_cast<char>(number);
    }
    return bytes;
  }
  /// Numbers of `bits` bits as longs, one bit after the other.
  std::string packed(int bits) const {
    std::vector<std::uint64_t> longs((numbers.size() * static_cast<std::size_t>(bits) + 63) / 64);
    std::size_t at = 0;
    for (const int number : numbers)
      for (int bit = 0; bit < bits; ++bit, ++at)
        longs[at / 64] |= static_cast<std::uint64_t>(number >> bit & 1) << at % 64;
    std::string payload = nbt_number(std::ssize(longs), 4);
    for (const std::uint64_t word : longs)
      payload += nbt_number(static_cast<std::int64_t>(word), 8);
    return payload;
  }
};

/// Block i of palettes: air, then concrete and unknown blocks.
std::string block_name(int i) {
  if (i == 0) return "minecraft:air";
  return i <= 16 ? std::string("minecraft:") + kColoredBlocks[i - 1].name
                 : "mod:thing" + std::to_string(i) + "[half=top]";
}
Rgb8 block_color(int i) {
  if (i > 16) return {127, 127, 127};
  const Value8 color = kColoredBlocks[i - 1].color;
  return {color.x, color.y, color.z};
}
std::string sponge_palette(int count) {
  std::string entries;
  for (int i = count - 1; i >= 0; --i) entries += nbt_int(block_name(i), i);
  return nbt_compound("Palette", entries);
}
std::string sponge(const TestBlocks& blocks, int palette, int version) {
  const std::string sides =
      nbt_short("Width", blocks.size.x) + nbt_short("Height", blocks.size.y) +
      nbt_short("Length", blocks.size.z) + nbt_int("Version", version) +
      nbt_tag(11, "Offset",
              nbt_number(3, 4) + nbt_number(-5, 4) + nbt_number(64, 4) + nbt_number(-7, 4));
  if (version < 3)
    return nbt_compound("Schematic",
                        nbt_bytes("BlockData", blocks.varints()) + sides + sponge_palette(palette));
  return nbt_compound(
      "",
      nbt_compound("Schematic", sides + nbt_compound("Blocks", nbt_bytes("Data", blocks.varints()) +
                                                                   sponge_palette(palette))));
}
std::string litematic_region(const std::string& name, const TestBlocks& blocks, Vec3i position,
                             Vec3i size, int palette, int bits) {
  std::vector<std::string> names;
  for (int i = 0; i < palette; ++i)
    names.push_back(nbt_tag(8, "Name", nbt_text(block_name(i))) + '\0');
  return nbt_compound(name, nbt_tag(12, "BlockStates", blocks.packed(bits)) +
                                nbt_triple("Position", position) + nbt_triple("Size", size) +
                                nbt_list("BlockStatePalette", 10, names));
}

class SchematicFile : public VolumeTest {
 protected:
  void expect_blocks(const std::string& name, const TestBlocks& blocks) const {
    const SourceVoxels read_back = read(name);
    const auto voxels = blocks.voxels();
    ASSERT_EQ(read_back.voxels.size(), voxels.size()) << name;
    ASSERT_EQ(read_back.colors.size(), voxels.size()) << name;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      EXPECT_EQ(read_back.voxels[i], voxels[i].first) << name;
      EXPECT_EQ(read_back.colors[i], block_color(voxels[i].second)) << name;
    }
  }
};

TEST_F(SchematicFile, SpongeHasTheBlocksOfAllVersions) {
  for (const int palette : {1, 17, 300})
    for (const int version : {1, 2, 3}) {
      const TestBlocks blocks({7, 3, 5}, palette, 1);
      write("s.schem", sponge(blocks, palette, version));
      expect_blocks("s.schem", blocks);
      EXPECT_EQ(open("s.schem")->grid()->origin, (Vec3d{-5, 64, -7}));
      EXPECT_EQ(open("s.schem")->grid()->levels, 3);
      EXPECT_EQ(open("s.schem")->up(), 'y');
    }
}

TEST_F(SchematicFile, RegionsOfLitematicaLieWhereTheyAre) {
  for (const auto& [palette, bits] : {std::pair{1, 2}, {4, 2}, {5, 3}, {17, 5}, {300, 9}}) {
    const TestBlocks blocks({5, 4, 6}, palette, 2);
    write("one.litematic",
          nbt_compound(
              "", nbt_int("Version", 6) +
                      nbt_compound("Regions", litematic_region("a", blocks, {9, 9, 9}, blocks.size,
                                                               palette, bits))));
    expect_blocks("one.litematic", blocks);
    // The upper corner of the same box, and a second box beside it.
    const Vec3i upper = Vec3i{9, 9, 9} + blocks.size - Vec3i{1, 1, 1};
    const TestBlocks other({2, 1, 1}, 2, 3);
    write("two.litematic",
          nbt_compound(
              "", nbt_compound("Regions",
                               litematic_region("a", blocks, upper, -blocks.size, palette, bits) +
                                   litematic_region("b", other, {-11, 9, 9}, other.size, 2, 2))));
    std::vector<Vec3i> expected;
    for (const auto& [voxel, number] : blocks.voxels()) expected.push_back(voxel + Vec3i{20, 0, 0});
    for (const auto& [voxel, number] : other.voxels()) expected.push_back(voxel);
    EXPECT_EQ(read("two.litematic").voxels, expected);
    EXPECT_EQ(open("two.litematic")->grid()->origin, (Vec3d{-11, 9, 9}));
    EXPECT_EQ(open("two.litematic")->grid()->levels, 5);
  }
}

TEST_F(SchematicFile, StructuresListTheirBlocks) {
  const TestBlocks blocks({4, 4, 4}, 17, 4);
  std::vector<std::string> names, places;
  for (int i = 0; i < 17; ++i) names.push_back(nbt_tag(8, "Name", nbt_text(block_name(i))) + '\0');
  for (const auto& [voxel, number] : blocks.voxels())
    places.push_back(
        nbt_list("pos", 3,
                 {nbt_number(voxel.x, 4), nbt_number(voxel.y, 4), nbt_number(voxel.z, 4)}) +
        nbt_int("state", number) + '\0');
  const std::string size =
      nbt_list("size", 3, {nbt_number(4, 4), nbt_number(4, 4), nbt_number(4, 4)});
  write("s.nbt",
        nbt_compound("", size + nbt_list("blocks", 10, places) + nbt_list("palette", 10, names)));
  expect_blocks("s.nbt", blocks);
  const std::string palette = nbt_list("", 10, names).substr(3);
  write("t.nbt", nbt_compound("", size + nbt_list("blocks", 10, places) +
                                      nbt_list("palettes", 9, {palette, palette})));
  expect_blocks("t.nbt", blocks);
}

TEST_F(SchematicFile, BlocksOfMceditAreNumbers) {
  const std::string sides = nbt_short("Width", 2) + nbt_short("Height", 2) + nbt_short("Length", 2);
  // Blocks 0 and 3 have a fifth half-byte in AddBlocks: low in byte 0, high in byte 1.
  const std::string blocks("\0\0\1\0\0\xFF\0\0", 8), more("\x01\x20\0\0", 4);
  write("m.schematic", nbt_compound("Schematic", sides + nbt_bytes("Blocks", blocks) +
                                                     nbt_bytes("AddBlocks", more)));
  EXPECT_EQ(read("m.schematic").voxels,
            (std::vector<Vec3i>{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 0}}));
  EXPECT_TRUE(read("m.schematic").colors.empty());
}

TEST_F(SchematicFile, AnExportComesBack) {
  const ColoredScene scene(6);
  ExportOptions options = scene.options;
  export_schem(path("all.schem"), scene.view(), scene.grid, options);
  const ImportResult result = import("all.schem");
  EXPECT_EQ(result.dag, scene.dag);
  EXPECT_EQ(result.grid.origin, scene.grid.origin);
  options.window = kWindow;
  export_schem(path("part.schem"), scene.view(), scene.grid, options);
  ColoredVoxels expected = colored_voxels_of(scene, kWindow);
  for (auto& [voxel, color] : expected) {
    const Value8 block = kColoredBlocks[nearest_block({color[0], color[1], color[2]})].color;
    color = {block.x, block.y, block.z};
  }
  EXPECT_EQ(read_back(path("part.schem"), kWindow.lo), expected);
}

TEST_F(SchematicFile, LabelsAreTheNamesOfBlocks) {
  const TestBlocks blocks({7, 3, 5}, 20, 1);
  write("s.schem", sponge(blocks, 20, 2));
  const auto source = open_voxel_source(path("s.schem"), {.labels = ""});
  const std::map<Label, std::string> names = source->label_names();
  std::vector<std::string> found, expected;
  source->visit_all([&](const VoxelBatch& batch) {
    for (const Label label : batch.labels) found.push_back(names.at(label));
  });
  for (const auto& [voxel, number] : blocks.voxels()) {
    const std::string name = block_name(number);
    expected.push_back(name.substr(0, name.find('[')));
  }
  EXPECT_EQ(found, expected);
}

TEST_F(SchematicFile, FilesThatNumberTheirBlocksOtherwiseAreNotJoined) {
  const auto open_labels = [&](const char* name, const char* block) {
    write(name, nbt_compound("Schematic", nbt_short("Width", 1) + nbt_short("Height", 1) +
                                              nbt_short("Length", 1) +
                                              nbt_compound("Palette", nbt_int(block, 0)) +
                                              nbt_bytes("BlockData", std::string(1, '\0'))));
    return open_voxel_source(path(name), {.labels = ""});
  };
  const auto join = [&](const char* first, const char* second) {
    std::vector<std::unique_ptr<VoxelSource>> sources;
    sources.push_back(open_labels("a.schem", first));
    sources.push_back(open_labels("b.schem", second));
    return joined_source(std::move(sources))->label_names();
  };
  EXPECT_EQ(join("minecraft:stone", "minecraft:stone").at(1), "minecraft:stone");
  EXPECT_TRUE(has(error_of([&] { join("minecraft:stone", "minecraft:dirt"); }),
                  "its label 1 is 'minecraft:dirt', and that of another file is"));
}

TEST_F(SchematicFile, DamageIsFound) {
  const TestBlocks blocks({3, 2, 2}, 3, 5);
  const std::string good = sponge(blocks, 3, 2);
  expect_no_prefix_is_read("s.schem", good);
  EXPECT_GT(flip_every_bit("s.schem", good), 500);
  const std::string regions = nbt_compound(
      "", nbt_compound("Regions", litematic_region("a", blocks, {}, blocks.size, 3, 2)));
  expect_no_prefix_is_read("r.litematic", regions);
  EXPECT_GT(flip_every_bit("r.litematic", regions), 500);
}

TEST_F(SchematicFile, ErrorsNameTheirPlace) {
  const std::string sides = nbt_short("Width", 2) + nbt_short("Height", 1) + nbt_short("Length", 1);
  const auto error = [&](const std::string& entries) {
    return error_of_bytes("s.schem", nbt_compound("Schematic", entries));
  };
  EXPECT_TRUE(
      has(error_of_bytes("s.schem", "nothing"), "byte 0: is not a file of named binary tags"));
  EXPECT_TRUE(has(error(nbt_short("Width", 2)), "has no entry Height"));
  EXPECT_TRUE(has(error(sides), "is neither a schematic nor a structure"));
  EXPECT_TRUE(has(error(sides + sponge_palette(2) + nbt_bytes("BlockData", "\1")),
                  "has 1 bytes for 2 blocks"));
  EXPECT_TRUE(has(error(sides + sponge_palette(2) + nbt_bytes("BlockData", "\1\1\1")),
                  "has more than 2 blocks"));
  EXPECT_TRUE(has(error(sides + sponge_palette(2) + nbt_bytes("BlockData", "\1\2")),
                  "block 2 is not in the palette of 2"));
  EXPECT_TRUE(
      has(error(sides + sponge_palette(2) + nbt_bytes("BlockData", "\x80\x80\x80\x80\x80\1")),
          "is longer than 5 bytes"));
  std::string deep;
  for (int i = 0; i < 600; ++i) deep += nbt_tag(10, "a", "");
  EXPECT_TRUE(has(error(deep), "nested more than 512 deep"));
  EXPECT_TRUE(
      has(error_of([&] { import("s.schem", 0.5); }), "has no values to compare with a threshold"));
}

}  // namespace
}  // namespace voxdag
