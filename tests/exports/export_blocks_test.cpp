// Compares exported files with the voxels. The importers, which have tests of their own, read back
// the formats that they know; the others have readers here.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <map>

#include "colored_scene.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/exports/grids/block_palette.hpp"
#include "voxdag/exports/grids/export_binvox.hpp"
#include "voxdag/exports/grids/export_playcanvas.hpp"
#include "voxdag/exports/grids/export_schem.hpp"
#include "voxdag/exports/grids/export_slices.hpp"
#include "voxdag/exports/grids/export_spc.hpp"
#include "voxdag/exports/grids/export_vox.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/imports/voxel_source.hpp"

namespace voxdag {
namespace {

using ColoredVoxels = std::map<VoxelKey, Rgb8>;

/// Reads a file with the importers. Voxels without colour are black.
ColoredVoxels read_back(const std::filesystem::path& path, Vec3i moved_by = {}) {
  ColoredVoxels voxels;
  open_voxel_source(path)->visit_all([&](const VoxelBatch& batch) {
    for (std::size_t i = 0; i < batch.places.size(); ++i) {
      const Vec3i v = Vec3i(batch.places[i]) + moved_by;
      EXPECT_TRUE(
          voxels.try_emplace({v.x, v.y, v.z}, batch.colors.empty() ? Rgb8{} : batch.colors[i])
              .second);
    }
  });
  return voxels;
}

bool is_inside(Vec3i v, const Box3i& box) {
  return v.x >= box.lo.x && v.y >= box.lo.y && v.z >= box.lo.z && v.x < box.hi.x &&
         v.y < box.hi.y && v.z < box.hi.z;
}

/// Returns the voxels of a scene in a box, black.
ColoredVoxels voxels_of(const ExportedScene& scene, const Box3i& box) {
  ColoredVoxels voxels;
  for (const Vec3i v : scene.voxels)
    if (is_inside(v, box)) voxels[{v.x, v.y, v.z}] = {};
  return voxels;
}
ColoredVoxels colored_voxels_of(const ColoredScene& scene, const Box3i& box) {
  ColoredVoxels voxels;
  for (const Vec3i v : scene.voxels) {
    const Value8 color = scene.value(v);
    if (is_inside(v, box)) voxels[{v.x, v.y, v.z}] = {color.x, color.y, color.z};
  }
  return voxels;
}

constexpr Box3i kWindow{{3, 1, 6}, {29, 32, 13}};

TEST(ExportBinvox, IsReadBack) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  export_binvox(dir / "v.binvox", scene.view(), scene.grid);
  EXPECT_EQ(read_back(dir / "v.binvox"), voxels_of(scene, whole_grid(5)));
  const auto grid = open_voxel_source(dir / "v.binvox")->grid();
  EXPECT_EQ(grid->origin, scene.grid.origin);
  EXPECT_EQ(grid->voxel_size, scene.grid.voxel_size);
  EXPECT_EQ(grid->levels, 5);

  export_binvox(dir / "w.binvox", scene.view(), scene.grid, windowed(kWindow.lo, kWindow.hi));
  EXPECT_TRUE(read_text(dir / "w.binvox").starts_with("#binvox 1\ndim 31 31 31\ntranslate "));
  EXPECT_EQ(read_back(dir / "w.binvox", kWindow.lo), voxels_of(scene, kWindow));
}

TEST(ExportSlices, AreReadBack) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  export_slices(dir / "grey", 2, scene.view(), scene.grid, windowed(kWindow.lo, kWindow.hi));
  EXPECT_EQ(read_back(dir / "grey", kWindow.lo), voxels_of(scene, kWindow));
  EXPECT_TRUE(std::filesystem::exists(dir / "grey/slice_0006.png"));
  EXPECT_FALSE(std::filesystem::exists(dir / "grey/slice_0007.png"));
  const nlohmann::json placement = nlohmann::json::parse(read_text(dir / "grey/placement.json"));
  EXPECT_EQ(placement["window"]["lo"], nlohmann::json({3, 1, 6}));
  EXPECT_EQ(placement["array"]["axes_slowest_to_fastest"], "zyx");

  const ColoredScene colored(6);
  export_slices(dir / "colored", 2, colored.view(), colored.grid, colored.options);
  EXPECT_EQ(read_back(dir / "colored"), colored_voxels_of(colored, whole_grid(6)));
}

TEST(ExportSlices, OfOtherAxesTurnTheVoxels) {
  const TempDir dir;
  const ExportedScene scene(4, 300);
  for (int axis = 0; axis < 2; ++axis) {
    const auto folder = dir / std::to_string(axis);
    export_slices(folder, axis, scene.view(), scene.grid);
    ColoredVoxels turned;
    for (const Vec3i v : scene.voxels)
      turned[axis == 0 ? VoxelKey{v.y, v.z, v.x} : VoxelKey{v.x, v.z, v.y}] = {};
    EXPECT_EQ(read_back(folder), turned);
  }
}

TEST(ExportSlices, TheFolderIsCompleteOrNotThere) {
  const TempDir dir;
  const ExportedScene scene(4, 300);
  ExportOptions options;
  int calls = 0;
  options.progress = [&](double, std::uint64_t) {
    if (++calls == 5) throw std::runtime_error("stop");
  };
  EXPECT_THROW(export_slices(dir / "s", 2, scene.view(), scene.grid, options), std::runtime_error);
  EXPECT_EQ(dir.count(), 0);
  export_slices(dir / "s/", 2, scene.view(), scene.grid);
  EXPECT_EQ(error_of([&] { export_slices(dir / "s", 2, scene.view(), scene.grid); }),
            (dir / "s").string() + ": exists and is not an empty folder: choose another name");
  EXPECT_EQ(dir.count(), 1);
}

TEST(ExportVox, FewColorsAreReadBackExactly) {
  const TempDir dir;
  const ColoredScene scene(2);
  const auto files = export_vox(dir / "v.vox", scene.view(), scene.grid, scene.options);
  EXPECT_EQ(files, std::vector{dir / "v.vox"});
  // The importer moves the scene to the corner of the grid.
  ColoredVoxels expected = colored_voxels_of(scene, whole_grid(6));
  EXPECT_EQ(read_back(dir / "v.vox"), expected);
  EXPECT_EQ(placement_of(dir / "v.vox")["array"]["content"],
            "a scene; voxel window.lo lies at -32, -32, 0");
}

TEST(ExportVox, ManyColorsAreNearThoseOfThePalette) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_vox(dir / "v.vox", scene.view(), scene.grid, scene.options);
  const ColoredVoxels expected = colored_voxels_of(scene, whole_grid(6));
  const ColoredVoxels found = read_back(dir / "v.vox");
  ASSERT_EQ(found.size(), expected.size());
  std::set<Rgb8> colors;
  double sum = 0;
  for (const auto& [voxel, color] : expected) {
    const Rgb8 other = found.at(voxel);
    colors.insert(other);
    for (std::size_t i = 0; i < 3; ++i) sum += (color[i] - other[i]) * (color[i] - other[i]);
  }
  EXPECT_LE(colors.size(), 255u);
  EXPECT_GT(colors.size(), 100u);
  // A cell of the palette's counter is 4 wide: values in it are at most 1.5 from their mean.
  EXPECT_LT(std::sqrt(sum / static_cast<double>(expected.size())), 1.5 * std::sqrt(3));
}

TEST(ExportVox, ModelsOf256AndWindowsAreCentred) {
  const TempDir dir;
  const ExportedScene scene(9, 3000);
  const Box3i window{{100, 3, 7}, {500, 512, 300}};
  export_vox(dir / "v.vox", scene.view(), scene.grid, windowed(window.lo, window.hi));
  const ColoredVoxels expected = voxels_of(scene, window);
  ColoredVoxels found = read_back(dir / "v.vox");
  EXPECT_EQ(found.size(), expected.size());
  // Relative to their first voxel, as the importer places the least one at 0.
  const auto corner = [](const ColoredVoxels& voxels) {
    Vec3i lo{1 << 20, 1 << 20, 1 << 20};
    for (const auto& [v, color] : voxels)
      lo = min(lo, {std::get<0>(v), std::get<1>(v), std::get<2>(v)});
    return lo;
  };
  const Vec3i move = corner(expected) - corner(found);
  ColoredVoxels moved;
  for (const auto& [v, color] : found) {
    EXPECT_EQ(color, (Rgb8{200, 198, 195}));
    moved[{std::get<0>(v) + move.x, std::get<1>(v) + move.y, std::get<2>(v) + move.z}] = {};
  }
  EXPECT_EQ(moved, expected);
}

/// The first voxels and the sizes of the models in a .vox file.
std::vector<std::pair<Vec3i, Vec3i>> models(const std::string& bytes) {
  std::vector<std::pair<Vec3i, Vec3i>> result;
  for (std::size_t at = bytes.find("SIZE"); at != std::string::npos;
       at = bytes.find("SIZE", at + 1)) {
    Vec3i size;
    std::memcpy(&size, bytes.data() + at + 12, sizeof size);
    result.emplace_back(Vec3i{}, size);
  }
  std::size_t model = 0;
  for (std::size_t at = bytes.find("_t"); at != std::string::npos; at = bytes.find("_t", at + 1)) {
    Vec3i middle;
    EXPECT_EQ(std::sscanf(bytes.c_str() + at + 6, "%d %d %d", &middle.x, &middle.y, &middle.z), 3);
    auto& [first, size] = result.at(model++);
    first = middle - Vec3i{size.x / 2, size.y / 2, size.z / 2};
  }
  return result;
}

TEST(ExportVox, LargeGridsAreCutIntoSectionsThatMagicaVoxelShows) {
  const TempDir dir;
  const ExportedScene scene(12, 50);
  const auto files = export_vox(dir / "v.vox", scene.view(), scene.grid);
  EXPECT_GT(files.size(), 1u);
  EXPECT_EQ(dir.count(), static_cast<int>(files.size()) + 1);
  std::size_t voxels = 0;
  for (const auto& file : files) {
    voxels += read_back(file).size();
    for (const auto& [first, size] : models(read_text(file)))
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(first[axis], -1000);
        EXPECT_LE(first[axis] + size[axis], 1000);
      }
  }
  EXPECT_EQ(voxels, scene.set.size());
  EXPECT_TRUE(std::filesystem::exists(dir / "v.vox.json"));
}

std::string unzipped(const std::filesystem::path& path) {
  const gzFile file = gzopen(path.c_str(), "rb");
  std::string text;
  char buffer[4096];
  for (int count; (count = gzread(file, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(count));
  EXPECT_EQ(gzclose(file), Z_OK);
  return text;
}

/// The tags of a schematic: numbers, the palette, and the blocks.
struct Nbt {
  std::map<std::string, std::int32_t> numbers, palette;
  std::string blocks;

  explicit Nbt(std::string nbt) : bytes(std::move(nbt)) {
    EXPECT_EQ(number(1), 10);
    EXPECT_EQ(name(), "Schematic");
    read_compound(numbers);
    EXPECT_EQ(at, bytes.size());
  }

 private:
  std::int32_t number(int count) {
    std::int32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at++));
    return value;
  }
  std::string name() {
    const auto length = static_cast<std::size_t>(number(2));
    at += length;
    return bytes.substr(at - length, length);
  }
  void read_compound(std::map<std::string, std::int32_t>& into) {
    for (int type; (type = number(1)) != 0;) {
      const std::string tag = name();
      if (type == 2) into[tag] = number(2);
      if (type == 3) into[tag] = number(4);
      if (type == 7) {
        const auto count = static_cast<std::size_t>(number(4));
        blocks = bytes.substr(at, count);
        at += count;
      }
      if (type == 9) at += 5;
      if (type == 10) read_compound(palette);
      if (type == 11) at += 4 * static_cast<std::size_t>(number(4));
    }
  }
  std::string bytes;
  std::size_t at = 0;
};

TEST(ExportSchem, BlocksAreTheVoxels) {
  const TempDir dir;
  const ColoredScene scene(4);
  for (const bool has_colors : {false, true}) {
    ExportOptions options = has_colors ? scene.options : ExportOptions{};
    options.window = kWindow;
    export_schem(dir / "v.schem", scene.view(), scene.grid, options);
    Nbt nbt(unzipped(dir / "v.schem"));
    EXPECT_EQ(nbt.numbers["Version"], 2);
    EXPECT_EQ(nbt.numbers["Width"], 26);
    EXPECT_EQ(nbt.numbers["Height"], 31);
    EXPECT_EQ(nbt.numbers["Length"], 7);
    EXPECT_EQ(nbt.numbers["PaletteMax"], std::ssize(nbt.palette));
    ASSERT_EQ(nbt.blocks.size(), 26u * 31 * 7);
    const ColoredVoxels voxels = colored_voxels_of(scene, kWindow);
    std::size_t place = 0;
    for (int y = 1; y < 32; ++y)
      for (int z = 6; z < 13; ++z)
        for (int x = 3; x < 29; ++x) {
          const auto voxel = voxels.find({x, y, z});
          std::string block = "air";
          if (voxel != voxels.end()) {
            const auto [red, green, blue] = voxel->second;
            block = has_colors ? kColoredBlocks[nearest_block({red, green, blue})].name : "stone";
          }
          EXPECT_EQ(nbt.blocks[place++], nbt.palette.at("minecraft:" + block));
        }
  }
  EXPECT_TRUE(std::filesystem::exists(dir / "v.schem.json"));
}

TEST(ExportSchem, ColorsBecomeTheNearestBlocks) {
  for (int i = 0; i < std::ssize(kColoredBlocks); ++i)
    EXPECT_EQ(nearest_block(kColoredBlocks[i].color), i);
  EXPECT_STREQ(kColoredBlocks[nearest_block({255, 255, 255})].name, "white_concrete");
  EXPECT_STREQ(kColoredBlocks[nearest_block({0, 0, 0})].name, "black_concrete");
}

TEST(ExportSchem, LimitsAreToldBeforeTheWork) {
  const TempDir dir;
  const ExportedScene scene(16, 10);
  const std::string file = (dir / "v.schem").string();
  const std::string help = ": choose a smaller --window, or make a coarser grid (voxdag coarsen)";
  EXPECT_EQ(error_of([&] { export_schem(file, scene.view(), scene.grid); }),
            file + ": 65536 blocks along an axis are more than the 32767 of a schematic" + help);
  EXPECT_EQ(
      error_of([&] {
        export_schem(file, scene.view(), scene.grid, windowed({0, 0, 0}, {2048, 2048, 512}));
      }),
      file + ": 2147483648 blocks, with air, are more than the 2147483647 of a schematic" + help);
  EXPECT_EQ(dir.count(), 0);
}

/// Reads the octree of PlayCanvas as its reader does: it descends by the bits of the block.
class PlayCanvasOctree {
 public:
  explicit PlayCanvasOctree(const std::filesystem::path& json)
      : metadata_(nlohmann::json::parse(read_text(json))) {
    std::string data = json.string();
    data.replace(data.size() - 4, 4, "bin");
    const std::string bytes = read_text(data);
    words_.resize(bytes.size() / 4);
    std::memcpy(words_.data(), bytes.data(), bytes.size());
    nodes_ = metadata_["nodeCount"];
    EXPECT_EQ(words_.size(), nodes_ + metadata_["leafDataCount"].get<std::size_t>());
  }
  const nlohmann::json& metadata() const { return metadata_; }
  bool is_solid(Vec3i v) const {
    if (nodes_ == 0) return false;
    std::size_t at = 0;
    for (int level = metadata_["treeDepth"].get<int>() - 1; level >= -1; --level) {
      const std::uint32_t word = words_.at(at);
      if (word == 0xFF000000) return true;
      const std::uint32_t mask = word >> 24;
      if (mask == 0) {
        const std::size_t bit =
            static_cast<std::size_t>((v.x & 3) + 4 * (v.y & 3) + 16 * (v.z & 3));
        return (words_.at(nodes_ + 2 * word + bit / 32) >> (bit % 32) & 1) != 0;
      }
      const Vec3i block{v.x >> 2, v.y >> 2, v.z >> 2};
      const int octant =
          (block.x >> level & 1) | (block.y >> level & 1) << 1 | (block.z >> level & 1) << 2;
      if ((mask >> octant & 1) == 0) return false;
      at = (word & 0xFFFFFF) + static_cast<std::size_t>(std::popcount(mask & ((1u << octant) - 1)));
      EXPECT_LT(at, nodes_);
    }
    return false;
  }

 private:
  nlohmann::json metadata_;
  std::vector<std::uint32_t> words_;
  std::size_t nodes_ = 0;
};

TEST(ExportPlayCanvas, TheReaderFindsTheVoxels) {
  const TempDir dir;
  for (const int levels : {2, 3, 5}) {
    // Full blocks, full cells above them, and single voxels.
    const int n = 1 << levels;
    const std::vector<Vec3i> voxels = voxels_where(levels, [&](Vec3i v) {
      return v.x >= n / 2 || (v.x < n / 4 && v.y < n / 4) || (v.x + 3 * v.y + 5 * v.z) % 7 == 0;
    });
    const Svdag dag = brute_svdag(levels, voxels);
    Grid grid;
    grid.levels = levels;
    grid.origin = {1, 2, 3};
    grid.voxel_size = 0.5;
    export_playcanvas(dir / "v.voxel.json", dag.view(), grid);
    const PlayCanvasOctree octree(dir / "v.voxel.json");
    std::set<VoxelKey> set;
    for (const Vec3i v : voxels) set.insert({v.x, v.y, v.z});
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) EXPECT_EQ(octree.is_solid({x, y, z}), set.contains({x, y, z}));
    EXPECT_EQ(octree.metadata()["gridBounds"]["min"], nlohmann::json({1.0, 2.0, 3.0}));
    EXPECT_EQ(octree.metadata()["gridBounds"]["max"][0], 1 + n * 0.5);
    EXPECT_EQ(octree.metadata()["voxelResolution"], 0.5);
  }
}

TEST(ExportPlayCanvas, EmptyAndFullGrids) {
  const TempDir dir;
  Grid grid;
  grid.levels = 4;
  const Svdag empty = brute_svdag(4, {});
  const Svdag full = brute_svdag(4, voxels_where(4, [](Vec3i) { return true; }));
  export_playcanvas(dir / "e.voxel.json", empty.view(), grid);
  export_playcanvas(dir / "f.voxel.json", full.view(), grid);
  EXPECT_FALSE(PlayCanvasOctree(dir / "e.voxel.json").is_solid({0, 0, 0}));
  EXPECT_TRUE(PlayCanvasOctree(dir / "f.voxel.json").is_solid({7, 8, 9}));
  EXPECT_EQ(PlayCanvasOctree(dir / "f.voxel.json").metadata()["nodeCount"], 1);
}

TEST(ExportPlayCanvas, MoreLeafBlocksThanPointersReachAreRefused) {
  const TempDir dir;
  SvdagView view;
  view.levels = 2;
  view.leaf_block_count = (std::uint64_t{1} << 24) + 1;
  EXPECT_EQ(
      error_of([&] { export_playcanvas(dir / "v.voxel.json", view, {}); }),
      (dir / "v.voxel.json").string() +
          ": 16777217 different leaf blocks are more than the 16777216 of this format: choose "
          "a smaller --window, or make a coarser grid (voxdag coarsen)");
}

/// Returns the points of an SPC octree, as kaolin generates them: breadth first, each node's
/// children in the order of their bits.
std::set<VoxelKey> spc_points(const std::string& npy, int levels) {
  std::size_t at = npy.find('\n') + 1;
  std::vector<Vec3i> cells{{0, 0, 0}};
  for (int level = 0; level < levels; ++level) {
    std::vector<Vec3i> children;
    for (const Vec3i cell : cells) {
      const auto mask = static_cast<unsigned char>(npy.at(at++));
      for (int child = 0; child < 8; ++child)
        if ((mask >> child & 1) != 0)
          children.push_back(
              {2 * cell.x + (child >> 2), 2 * cell.y + (child >> 1 & 1), 2 * cell.z + (child & 1)});
    }
    cells = children;
  }
  EXPECT_EQ(at, npy.size());
  std::set<VoxelKey> points;
  for (const Vec3i cell : cells) points.insert({cell.x, cell.y, cell.z});
  return points;
}

TEST(ExportSpc, KaolinFindsTheVoxels) {
  const TempDir dir;
  for (const int levels : {2, 3, 6}) {
    const ExportedScene scene(levels, 20 << levels);
    export_spc(dir / "v.spc.npy", scene.view(), scene.grid);
    EXPECT_EQ(spc_points(read_text(dir / "v.spc.npy"), levels), scene.set);
    EXPECT_EQ(placement_of(dir / "v.spc.npy")["grid"]["resolution"], 1 << levels);
  }
  const ExportedScene empty(4, 0), large(16, 5);
  export_spc(dir / "e.spc.npy", empty.view(), empty.grid);
  EXPECT_EQ(NpyReader(dir / "e.spc.npy", "|u1", {}, 1).rows(), 0u);
  EXPECT_EQ(error_of([&] { export_spc(dir / "l.spc.npy", large.view(), large.grid); }),
            (dir / "l.spc.npy").string() +
                ": 65536 voxels a side are more than the 32768 of kaolin: choose a smaller "
                "--window, or make a coarser grid (voxdag coarsen)");
}

TEST(ExportBlocks, CancellingLeavesNothing) {
  const TempDir dir;
  const ColoredScene scene(6);
  ExportOptions options = scene.options;
  options.progress = [](double, std::uint64_t) { throw std::runtime_error("stop"); };
  EXPECT_ANY_THROW(export_vox(dir / "v.vox", scene.view(), scene.grid, options));
  EXPECT_ANY_THROW(export_binvox(dir / "v.binvox", scene.view(), scene.grid, options));
  EXPECT_ANY_THROW(export_schem(dir / "v.schem", scene.view(), scene.grid, options));
  EXPECT_ANY_THROW(export_playcanvas(dir / "v.voxel.json", scene.view(), scene.grid, options));
  EXPECT_EQ(dir.count(), 0);
}

TEST(ExportBlocks, AnEmptyDagMakesFilesWithoutVoxels) {
  const TempDir dir;
  const ExportedScene scene(4, 0);
  export_vox(dir / "v.vox", scene.view(), scene.grid);
  export_binvox(dir / "v.binvox", scene.view(), scene.grid);
  export_schem(dir / "v.schem", scene.view(), scene.grid);
  EXPECT_TRUE(read_back(dir / "v.vox").empty());
  EXPECT_TRUE(read_back(dir / "v.binvox").empty());
  EXPECT_EQ(Nbt(unzipped(dir / "v.schem")).blocks, std::string(16 * 16 * 16, '\0'));
}

}  // namespace
}  // namespace voxdag
