#include "voxdag/file/export.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/number_colors.hpp"
#include "support/temp_dir.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/export_count.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag {
namespace {

using Key = std::tuple<int, int, int>;

struct Scene {
  explicit Scene(int levels, int count = 300)
      : voxels(random_voxels(levels, count, 5)), dag(brute_svdag(levels, voxels)) {
    grid.levels = levels;
    grid.origin = {10, -20, 0.5};
    grid.voxel_size = 0.25;
    for (const Vec3i v : voxels) set.insert({v.x, v.y, v.z});
  }
  SvdagView view() const { return dag.view(); }
  bool has(int x, int y, int z) const { return set.contains({x, y, z}); }

  std::vector<Vec3i> voxels;
  Svdag dag;
  Grid grid;
  std::set<Key> set;
};

ExportOptions windowed(Vec3i lo, Vec3i hi) {
  ExportOptions options;
  options.window = Box3i{lo, hi};
  return options;
}

nlohmann::json placement_of(const std::filesystem::path& path) {
  return nlohmann::json::parse(read_text(path.string() + ".json"));
}

TEST(ExportNpy, CoordinatesAreTheVoxelsInMortonOrder) {
  const TempDir dir;
  const Scene scene(7, 30000);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid);
  NpyReader reader(dir / "v.npy", "<i4", {3}, 4);
  ASSERT_EQ(reader.rows(), scene.set.size());
  std::vector<Vec3i> rows(reader.rows());
  reader.read_rows(rows.data(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_TRUE(scene.has(rows[i].x, rows[i].y, rows[i].z));
    if (i == 0) continue;
    EXPECT_LT(morton_encode(rows[i - 1]), morton_encode(rows[i]));
  }
}

TEST(ExportNpy, CoordinatesKeepToTheWindow) {
  const TempDir dir;
  const Scene scene(5, 2000);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid, windowed({1, 2, 3}, {9, 21, 30}));
  NpyReader reader(dir / "v.npy", "<i4", {3}, 4);
  std::size_t expected = 0;
  for (const auto& [x, y, z] : scene.set)
    expected += x >= 1 && y >= 2 && z >= 3 && x < 9 && y < 21 && z < 30;
  EXPECT_EQ(reader.rows(), expected);
}

TEST(ExportNpy, ThePlacementIsWrittenBesideIt) {
  const TempDir dir;
  const Scene scene(5);
  export_npy_dense(dir / "v.npy", scene.view(), scene.grid, windowed({1, 2, 3}, {9, 21, 30}));
  const nlohmann::json json = placement_of(dir / "v.npy");
  EXPECT_EQ(json["grid"]["origin"], nlohmann::json({10.0, -20.0, 0.5}));
  EXPECT_EQ(json["grid"]["voxel_size"], 0.25);
  EXPECT_EQ(json["grid"]["resolution"], 32);
  EXPECT_EQ(json["window"]["lo"], nlohmann::json({1, 2, 3}));
  EXPECT_EQ(json["window"]["hi"], nlohmann::json({9, 21, 30}));
  EXPECT_EQ(json["array"]["axes_slowest_to_fastest"], "xyz");
  EXPECT_EQ(json["array"]["shape"], nlohmann::json({8, 19, 27}));
  EXPECT_EQ(dir.count(), 2);
}

TEST(ExportNpy, ADenseWindowHasZFastest) {
  const TempDir dir;
  const Scene scene(5, 2000);
  const Vec3i lo{1, 2, 3}, hi{9, 21, 30};
  export_npy_dense(dir / "v.npy", scene.view(), scene.grid, windowed(lo, hi));
  NpyReader reader(dir / "v.npy", "|u1", {19, 27}, 1);
  ASSERT_EQ(reader.rows(), 8u);
  std::vector<unsigned char> bytes(8 * 19 * 27);
  reader.read_rows(bytes.data(), 8);
  std::size_t at = 0;
  for (int x = lo.x; x < hi.x; ++x)
    for (int y = lo.y; y < hi.y; ++y)
      for (int z = lo.z; z < hi.z; ++z) ASSERT_EQ(bytes[at++] != 0, scene.has(x, y, z));
}

TEST(ExportRaw, TheWholeGridHasXFastest) {
  const TempDir dir;
  const Scene scene(5, 2000);
  export_raw(dir / "v.raw", scene.view(), scene.grid);
  const std::string bytes = read_text(dir / "v.raw");
  ASSERT_EQ(bytes.size(), 32u * 32 * 32);
  std::size_t at = 0;
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) ASSERT_EQ(bytes[at++] != 0, scene.has(x, y, z));
  EXPECT_EQ(placement_of(dir / "v.raw")["array"]["axes_slowest_to_fastest"], "zyx");
}

/// Arrays of more than one strip. Strips end between layers and within a layer.
TEST(ExportRaw, LargeArraysAreWrittenInStrips) {
  const TempDir dir;
  for (const auto& [levels, size] : {std::pair{11, Vec3i{2048, 2048, 11}}, {13, {8192, 6000, 1}}}) {
    std::vector<Vec3i> voxels;
    std::mt19937 rng(1);
    for (int i = 0; i < 2000; ++i)
      voxels.push_back({static_cast<int>(rng() % size.x), static_cast<int>(rng() % size.y),
                        static_cast<int>(rng() % size.z)});
    const Svdag dag = brute_svdag(levels, voxels);
    Grid grid;
    grid.levels = levels;
    export_raw(dir / "v.raw", dag.view(), grid, windowed({0, 0, 0}, size));
    std::string bytes = read_text(dir / "v.raw");
    ASSERT_EQ(bytes.size(), std::size_t(size.x) * size.y * size.z);
    for (const Vec3i v : voxels) {
      char& byte = bytes[v.x + std::size_t(size.x) * (v.y + std::size_t(size.y) * v.z)];
      byte = byte == 0 ? 2 : 3;  // 2: the voxel was not set, but should be
      ASSERT_EQ(byte, 3);
    }
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 1), 0);
  }
}

TEST(ExportRaw, TooLargeAnArrayIsRefusedWithItsSize) {
  const TempDir dir;
  const Scene scene(15, 10);
  EXPECT_EQ(error_of([&] { export_raw(dir / "v.raw", scene.view(), scene.grid); }),
            (dir / "v.raw").string() +
                ": a dense array of 32768 x 32768 x 32768 voxels has 35184372088832 bytes, more "
                "than the limit of 17179869184: choose a smaller window");
  EXPECT_EQ(dir.count(), 0);
}

TEST(Export, AWindowMustLieInTheGrid) {
  const TempDir dir;
  const Scene scene(4);
  const auto with = [&](Vec3i lo, Vec3i hi) {
    return voxdag::error_of(
        [&] { export_npy_dense("v.npy", scene.view(), scene.grid, windowed(lo, hi)); });
  };
  EXPECT_EQ(with({0, 0, 0}, {17, 1, 1}),
            "v.npy: window: extends beyond the grid of 16 voxels a side");
  EXPECT_EQ(with({-1, 0, 0}, {1, 1, 1}),
            "v.npy: window: extends beyond the grid of 16 voxels a side");
  EXPECT_EQ(with({0, 5, 0}, {1, 5, 1}),
            "v.npy: window: is empty: each end must be greater than its start");
}

/// A binary PLY file from an exporter.
struct Ply {
  explicit Ply(const std::string& bytes) {
    const std::size_t end = bytes.find("end_header\n") + 11;
    std::istringstream header(bytes.substr(0, end));
    std::size_t vertex_count = 0, face_count = 0;
    bool is_double = false, has_normals = false, has_colors = false, has_materials = false;
    for (std::string line; std::getline(header, line);) {
      if (line.starts_with("element vertex ")) vertex_count = std::stoull(line.substr(15));
      if (line.starts_with("element face ")) face_count = std::stoull(line.substr(13));
      if (line == "property double x") is_double = true;
      if (line == "property float nx") has_normals = true;
      if (line == "property uchar red") has_colors = true;
      if (line == "property ushort material") has_materials = true;
    }
    std::size_t at = end;
    const auto take = [&]<class T>(T& value) {
      std::memcpy(&value, bytes.data() + at, sizeof value);
      at += sizeof value;
    };
    for (std::size_t i = 0; i < vertex_count; ++i) {
      Vec3f small;
      Vec3d large;
      if (is_double)
        take(large);
      else
        take(small), large = Vec3d(small);
      vertices.push_back(large);
      if (has_normals) take(normals.emplace_back());
      if (has_colors) take(colors.emplace_back());
      if (has_materials) take(materials.emplace_back());
    }
    for (std::size_t i = 0; i < face_count; ++i) {
      unsigned char corners;
      take(corners);
      EXPECT_EQ(corners, 4);
      take(faces.emplace_back());
    }
    EXPECT_EQ(at, bytes.size());
    has_doubles = is_double;
  }
  std::vector<Vec3d> vertices;
  std::vector<Vec3f> normals;
  std::vector<Value8> colors;
  std::vector<std::uint16_t> materials;
  std::vector<std::array<std::uint32_t, 4>> faces;
  bool has_doubles = false;
};

TEST(ExportPly, PointsAreVoxelCentresInTheWorld) {
  const TempDir dir;
  const Scene scene(6, 500);
  export_ply_points(dir / "v.ply", scene.view(), scene.grid);
  const Ply ply(read_text(dir / "v.ply"));
  EXPECT_FALSE(ply.has_doubles);
  std::set<Key> found;
  for (const Vec3d p : ply.vertices) {
    const Vec3d voxel = (p - scene.grid.origin) * 4.0 - Vec3d{0.5, 0.5, 0.5};
    EXPECT_EQ(Vec3d(Vec3i(voxel)), voxel);
    found.insert({int(voxel.x), int(voxel.y), int(voxel.z)});
  }
  EXPECT_EQ(found, scene.set);
  EXPECT_EQ(ply.vertices.size(), scene.set.size());
  EXPECT_EQ(dir.count(), 1);
}

TEST(ExportPly, FarFromTheOriginCoordinatesAreDoubles) {
  const TempDir dir;
  Scene scene(6, 100);
  scene.grid.origin.x = 4e6;
  export_ply_points(dir / "v.ply", scene.view(), scene.grid);
  const Ply ply(read_text(dir / "v.ply"));
  EXPECT_TRUE(ply.has_doubles);
  EXPECT_EQ(ply.vertices.size(), scene.set.size());
  EXPECT_EQ(std::fmod(ply.vertices[0].x, 0.25), 0.125);
}

/// Returns the faces by voxel and outward direction, computed from the centre and normal of each
/// quad of the PLY.
std::map<std::pair<Key, Key>, int> faces_of(const Ply& ply, const Grid& grid) {
  std::map<std::pair<Key, Key>, int> faces;
  for (const auto& face : ply.faces) {
    std::array<Vec3d, 4> p;
    for (int i = 0; i < 4; ++i)
      p[i] = (ply.vertices.at(face[i]) - grid.origin) * (1 / grid.voxel_size);
    const Vec3d normal = cross(p[1] - p[0], p[2] - p[1]);
    EXPECT_EQ(p[0] + p[2], p[1] + p[3]);
    EXPECT_EQ(dot(normal, normal), 1);
    const Vec3d inside = (p[0] + p[2]) * 0.5 - normal * 0.5 - Vec3d{0.5, 0.5, 0.5};
    ++faces[{{int(inside.x), int(inside.y), int(inside.z)},
             {int(normal.x), int(normal.y), int(normal.z)}}];
  }
  return faces;
}

TEST(ExportPly, FacesHaveNoNeighbourAndPointOutwards) {
  const TempDir dir;
  for (const bool cropped : {false, true}) {
    const Scene scene(4, 1500);
    const Vec3i lo = cropped ? Vec3i{1, 2, 3} : Vec3i{0, 0, 0};
    const Vec3i hi = cropped ? Vec3i{15, 10, 11} : Vec3i{16, 16, 16};
    export_ply_faces(dir / "v.ply", scene.view(), scene.grid, windowed(lo, hi));
    const Ply ply(read_text(dir / "v.ply"));
    const auto has = [&](Vec3i v) {
      return max(v, lo) == v && max(v + Vec3i{1, 1, 1}, hi) == hi && scene.has(v.x, v.y, v.z);
    };
    std::map<std::pair<Key, Key>, int> expected;
    for (const auto& [x, y, z] : scene.set)
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
          Vec3i step{};
          step[axis] = side;
          if (has({x, y, z}) && !has(Vec3i{x, y, z} + step))
            expected[{{x, y, z}, {step.x, step.y, step.z}}] = 1;
        }
    EXPECT_EQ(faces_of(ply, scene.grid), expected);
  }
}

TEST(ExportPly, ALoneVoxelHasEightSharedCorners) {
  const TempDir dir;
  const Svdag dag = brute_svdag(3, {{3, 4, 7}});
  Grid grid;
  grid.levels = 3;
  export_ply_faces(dir / "v.ply", dag.view(), grid);
  const Ply ply(read_text(dir / "v.ply"));
  EXPECT_EQ(ply.vertices.size(), 8u);
  EXPECT_EQ(ply.faces.size(), 6u);
}

/// A scene whose cells have attributes that tell their numbers.
struct ColoredScene : Scene {
  explicit ColoredScene(int finest_level)
      : Scene(6, 900), finest(finest_level), attributes(dag.view(), finest_level) {
    // A parent is before its children, and children are in Morton order.
    std::set<std::pair<std::uint64_t, int>> cells;
    for (const Vec3i v : voxels)
      for (int level = 0; level <= finest; ++level)
        cells.insert({first_code(morton_encode(v), level), level});
    for (const auto& cell : cells) numbers.emplace(cell, numbers.size());
    options.look = attributes.view();
  }
  /// Returns the code of the first voxel in the cell of `level` that holds the voxel.
  std::uint64_t first_code(std::uint64_t code, int level) const {
    const int shift = 3 * (grid.levels - level);
    return code >> shift << shift;
  }
  /// Returns the number of the voxel, or of the cell of the finest level that holds it.
  std::uint64_t number(Vec3i voxel) const {
    return numbers.at({first_code(morton_encode(voxel), finest), finest});
  }
  Value8 value(Vec3i voxel) const { return color_of_number(number(voxel)); }

  int finest;
  NumberColors attributes;
  std::map<std::pair<std::uint64_t, int>, std::uint64_t> numbers;
  ExportOptions options;
};

TEST(ExportPly, PointsHaveTheAttributesOfTheirCells) {
  for (const int finest : {6, 5, 3, 0}) {
    const TempDir dir;
    const ColoredScene scene(finest);
    export_ply_points(dir / "v.ply", scene.view(), scene.grid, scene.options);
    const Ply ply(read_text(dir / "v.ply"));
    ASSERT_EQ(ply.vertices.size(), scene.set.size());
    for (std::size_t i = 0; i < ply.vertices.size(); ++i) {
      const Vec3i voxel((ply.vertices[i] - scene.grid.origin) * 4.0);
      ASSERT_EQ(ply.colors.at(i), scene.value(voxel));
      ASSERT_EQ(ply.normals.at(i), unpack_normal(scene.value(voxel)));
      ASSERT_EQ(ply.materials.at(i), material_of_number(scene.number(voxel)));
    }
  }
}

TEST(ExportPly, FacesHaveTheAttributesOfTheirVoxel) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_ply_faces(dir / "grey.ply", scene.view(), scene.grid);
  export_ply_faces(dir / "v.ply", scene.view(), scene.grid, scene.options);
  const Ply ply(read_text(dir / "v.ply"));
  EXPECT_EQ(faces_of(ply, scene.grid), faces_of(Ply(read_text(dir / "grey.ply")), scene.grid));
  for (const auto& face : ply.faces) {
    std::array<Vec3d, 4> p;
    for (int i = 0; i < 4; ++i) p[i] = (ply.vertices.at(face[i]) - scene.grid.origin) * 4.0;
    const Vec3d inside = (p[0] + p[2]) * 0.5 - cross(p[1] - p[0], p[2] - p[1]) * 0.5;
    for (const std::uint32_t corner : face) {
      ASSERT_EQ(ply.colors.at(corner), scene.value(Vec3i(inside)));
      ASSERT_EQ(ply.normals.at(corner), unpack_normal(scene.value(Vec3i(inside))));
      ASSERT_EQ(ply.materials.at(corner), material_of_number(scene.number(Vec3i(inside))));
    }
  }
}

TEST(ExportNpy, CoordinatesComeWithAttributes) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid, scene.options);
  const std::string dtype =
      "[('voxel', '<i4', (3,)), ('normal', '<f4', (3,)), ('color', '|u1', (3,)), "
      "('material', '<u2')]";
  constexpr std::size_t kBytes = 29;
  NpyReader reader(dir / "v.npy", dtype, {}, kBytes);
  ASSERT_EQ(reader.rows(), scene.set.size());
  std::string row(kBytes, '\0');
  while (reader.read_rows(row.data(), 1) == 1) {
    const Vec3i voxel = peek<Vec3i>(row, 0);
    ASSERT_TRUE(scene.has(voxel.x, voxel.y, voxel.z));
    ASSERT_EQ(peek<Vec3f>(row, 12), unpack_normal(scene.value(voxel)));
    ASSERT_EQ(peek<Value8>(row, 24), scene.value(voxel));
    ASSERT_EQ(peek<std::uint16_t>(row, 27), material_of_number(scene.number(voxel)));
  }
  EXPECT_EQ(placement_of(dir / "v.npy")["array"]["dtype"], dtype);
}

TEST(Export, TheExtensionChooses) {
  const TempDir dir;
  const Scene scene(3, 20);
  const auto run = [&](const std::string& name, PlyContent content) {
    export_voxels(dir / name, scene.view(), scene.grid, content);
    return read_text(dir / name);
  };
  EXPECT_EQ(run("a.npy", PlyContent::kPoints).substr(1, 5), "NUMPY");
  EXPECT_EQ(run("a.raw", PlyContent::kPoints).size(), 512u);
  EXPECT_TRUE(Ply(run("a.ply", PlyContent::kPoints)).faces.empty());
  EXPECT_FALSE(Ply(run("b.ply", PlyContent::kFaces)).faces.empty());
  EXPECT_EQ(error_of([&] { run("a.xyz", PlyContent::kPoints); }),
            (dir / "a.xyz").string() +
                ": cannot export to '.xyz': the extension must be .npy, .ply or .raw");
}

TEST(Export, AnEmptyDagMakesEmptyFiles) {
  const TempDir dir;
  const Scene scene(4, 0);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid);
  EXPECT_EQ(NpyReader(dir / "v.npy", "<i4", {3}, 4).rows(), 0u);
  export_ply_faces(dir / "v.ply", scene.view(), scene.grid);
  EXPECT_TRUE(Ply(read_text(dir / "v.ply")).vertices.empty());
}

TEST(Export, VoxelsAreCountedAsTheyAreEnumerated) {
  const Scene scene(8, 3000);
  const std::uint64_t most = 1 << 30;
  for (const Box3i& window : {Box3i{{0, 0, 0}, {256, 256, 256}}, Box3i{{3, 0, 17}, {200, 256, 18}},
                              Box3i{{1, 2, 3}, {255, 254, 253}}, Box3i{{5, 5, 5}, {6, 6, 6}}}) {
    std::uint64_t enumerated = 0;
    VoxelSet(scene.view()).for_each_voxel(window, [&](Vec3i) { ++enumerated; });
    EXPECT_EQ(count_voxels(scene.view(), window, most, [] {}), enumerated);
  }
  EXPECT_EQ(count_voxels(scene.view(), whole_grid(8), 10, [] {}), 11u);
}

/// A full cube of 2^levels voxels per side: one node per level.
struct FullCube {
  explicit FullCube(int levels) {
    nodes.clear();
    for (int level = 0; level < levels - 2; ++level) {
      const auto next = static_cast<std::uint32_t>(9 * (level + 1));
      nodes.push_back(0xff);
      nodes.insert(nodes.end(), 8, level + 1 == levels - 2 ? 0 : next);
    }
  }
  std::vector<std::uint32_t> nodes;
  std::uint64_t block = ~std::uint64_t{0};
};

TEST(Export, AnOutputLargerThanTheDiskIsRefusedAtOnce) {
  FullCube cube(20);
  SvdagView view;
  view.levels = 20;
  view.nodes = cube.nodes.data();
  view.leaf_blocks = &cube.block;
  view.leaf_block_count = 1;
  EXPECT_EQ(count_voxels(view, whole_grid(20), ~std::uint64_t{0} - 1, [] {}),
            std::uint64_t{1} << 60);
  Grid grid;
  grid.levels = 20;
  const TempDir dir;
  for (const char* name : {"v.npy", "v.ply"})
    EXPECT_NE(error_of([&] {
                export_voxels(dir / name, view, grid, PlyContent::kPoints);
              }).find("bytes that are free on its disk"),
              std::string::npos);
  EXPECT_EQ(dir.count(), 0);
}

TEST(Export, CancellingLeavesNothing) {
  const TempDir dir;
  const Scene scene(5, 100);
  ExportOptions options;
  options.progress = [](double, std::uint64_t) { throw Cancelled(); };
  EXPECT_THROW(export_raw(dir / "v.raw", scene.view(), scene.grid, options), Cancelled);
  EXPECT_EQ(dir.count(), 0);
}

TEST(Export, AFullDiskIsAnError) {
  const Scene scene(5, 100);
  EXPECT_EQ(error_of([&] { export_raw("/dev/full", scene.view(), scene.grid); }),
            "/dev/full: byte 0: cannot write: No space left on device");
}

}  // namespace
}  // namespace voxdag
