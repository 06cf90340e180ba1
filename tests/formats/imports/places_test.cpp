// Where points and volumes lie: lattices, axes, and the places that exports write beside their
// files.
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>

#include "formats/exports/exported_scene.hpp"
#include "gzip_text.hpp"
#include "random_volume.hpp"
#include "voxdag/formats/exports/grids/export_slices.hpp"
#include "voxdag/formats/exports/grids/export_vox.hpp"
#include "voxdag/formats/imports/file_placement.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"

namespace voxdag {
namespace {

class Places : public VolumeTest {
 protected:
  ImportResult import_with(const std::string& name, ImportOptions options) const {
    options.folder = dir_.path();
    return import_voxels(*open(name), options);
  }
};

/// Returns the decimal number count * step / 10^digits as a text.
std::string decimal(std::int64_t units, int digits) {
  std::string text = std::to_string(std::abs(units));
  if (text.size() <= static_cast<std::size_t>(digits))
    text.insert(0, static_cast<std::size_t>(digits) + 1 - text.size(), '0');
  text.insert(text.size() - static_cast<std::size_t>(digits), ".");
  return (units < 0 ? "-" : "") + text;
}

/// Points of a lattice of `step` units, each coordinate a decimal number of `digits` digits behind
/// the point.
struct Lattice {
  std::int64_t first, step;
  int digits;

  std::string point(Vec3i v) const {
    std::string line;
    for (int axis = 0; axis < 3; ++axis) line += decimal(first + v[axis] * step, digits) + " ";
    return line;
  }
  double number(std::int64_t units) const { return std::atof(decimal(units, digits).c_str()); }
};

constexpr Lattice kLattices[] = {{0, 1, 1},           {0, 5, 2},
                                 {-77, 3, 1},         {46'497'761, 1, 1},
                                 {123'456'789, 1, 3}, {-5'000'000'001, 7, 4},
                                 {1, 333, 3},         {7, 1, 5}};

TEST_F(Places, EachPointOfALatticeHasItsVoxel) {
  std::vector<Vec3i> voxels;
  for (int i = 0; i < 64; ++i) voxels.push_back({i, i * 7 % 64, 63 - i});
  for (const Lattice& lattice : kLattices) {
    std::string text;
    for (const Vec3i v : voxels) text += lattice.point(v) + "\n";
    write("p.xyz", text);
    const double size = lattice.number(lattice.step);
    ImportOptions options;
    options.voxel_size = size;
    const ImportResult centred = import_with("p.xyz", options);
    EXPECT_EQ(centred.dag, brute_svdag(6, voxels)) << lattice.point({});
    EXPECT_EQ(centred.grid.levels, 6);

    // Points on the planes between voxels, wherever the grid begins.
    for (const int begin : {0, 3, 17, 1000}) {
      const double lo = lattice.number(lattice.first - begin * lattice.step),
                   hi = lattice.number(lattice.first + (2048 - begin) * lattice.step);
      options.bounds = Box3d{{lo, lo, lo}, {hi, hi, hi}};
      std::vector<Vec3i> moved;
      for (const Vec3i v : voxels) moved.push_back(v + Vec3i{begin, begin, begin});
      EXPECT_EQ(import_with("p.xyz", options).dag, brute_svdag(11, moved))
          << lattice.point({}) << begin;
    }
  }
}

TEST_F(Places, PointsBetweenPlanesStayInTheirVoxels) {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> inside(0.001, 0.999);
  const Grid grid{10, {4'649'776.1, -0.3, 17}, 0.05, kSubvoxels / 0.05};
  for (const CoordinateError& error : {CoordinateError{}, CoordinateError{0x1p-51, {1e-9, 0, 0}}}) {
    const PointLocator locator(grid, error);
    for (int i = 0; i < 100'000; ++i) {
      const Vec3i voxel{static_cast<int>(rng() % 1024), static_cast<int>(rng() % 1024),
                        static_cast<int>(rng() % 1024)};
      Vec3d point;
      for (int axis = 0; axis < 3; ++axis)
        point[axis] = grid.origin[axis] + (voxel[axis] + inside(rng)) * grid.voxel_size;
      EXPECT_EQ(locator.voxel(point), voxel);
    }
  }
  // Floats so far away that their steps are longer than voxels are not moved by more than 1/64.
  const PointLocator coarse({4, {0, 0, 0}, 0.01, kSubvoxels / 0.01}, {0x1p-2, {}});
  EXPECT_EQ(coarse.index(0.0798, 0), 7);
  EXPECT_EQ(coarse.index(0.0799, 0), 8);
}

TEST_F(Places, AnExportedCloudComesBackToItsPlace) {
  for (const double size : {0.1, 0.25, 1.0 / 3}) {
    ExportedScene scene(5);
    scene.grid.voxel_size = size;
    scene.grid.quantization_scale = kSubvoxels / size;
    export_ply_points(dir_ / "p.ply", VoxelSet(scene.view()), scene.grid, {});
    for (const std::optional<double> asked : {std::optional<double>(), std::optional(size)}) {
      ImportOptions options;
      options.voxel_size = asked;
      const ImportResult back = import_with("p.ply", options);
      EXPECT_EQ(back.grid.origin, scene.grid.origin);
      EXPECT_EQ(back.grid.voxel_size, size);
      EXPECT_EQ(back.dag, scene.dag);
    }
  }
}

TEST_F(Places, ExportedVoxelsComeBackToTheirPlace) {
  const ExportedScene scene(5);
  const VoxelSet voxels(scene.view());
  const Box3i window{{3, 1, 6}, {29, 32, 13}};
  for (const bool is_cut : {false, true}) {
    std::vector<Vec3i> kept;
    for (const Vec3i v : scene.voxels)
      if (!is_cut || (v.x >= 3 && v.x < 29 && v.y >= 1 && v.z >= 6 && v.z < 13)) kept.push_back(v);
    const Svdag expected = brute_svdag(5, kept);
    ExportOptions options;
    if (is_cut) options.window = window;
    export_npy_coordinates(dir_ / "v.npy", voxels, scene.grid, options);
    export_npy_dense(dir_ / "d.npy", voxels, scene.grid, options);
    export_vox(dir_ / "v.vox", voxels, scene.grid, options);
    std::vector<std::string> names = {"v.npy", "d.npy", "v.vox"};
    for (int axis = 0; axis < 3; ++axis) {
      names.push_back("slices" + std::to_string(axis) + std::to_string(is_cut));
      export_slices(dir_ / names.back(), axis, voxels, scene.grid, options);
    }
    for (const std::string& name : names) {
      const ImportResult back = import(name);
      EXPECT_EQ(back.dag, expected) << name;
      EXPECT_EQ(back.grid.levels, 5) << name;
      EXPECT_EQ(back.grid.origin, scene.grid.origin) << name;
      EXPECT_EQ(back.grid.voxel_size, scene.grid.voxel_size) << name;
    }
    // The placement may lie beside the file as it was before it was compressed.
    write("v.npy.gz", gzip(read_text(dir_ / "v.npy")));
    EXPECT_EQ(import("v.npy.gz").dag, expected);
    EXPECT_EQ(import("v.npy.gz").grid.origin, scene.grid.origin);
  }
}

TEST_F(Places, PlacementsOfOtherFilesAreRefused) {
  const ExportedScene scene(5);
  export_npy_coordinates(dir_ / "v.npy", VoxelSet(scene.view()), scene.grid,
                         windowed({0, 0, 0}, {16, 16, 16}));
  const std::string good = read_text(dir_ / "v.npy.json");
  EXPECT_EQ(error_of([&] { import("v.npy"); }), "no error");
  std::filesystem::rename(dir_ / "v.npy", dir_ / "small.npy");
  export_npy_coordinates(dir_ / "v.npy", VoxelSet(scene.view()), scene.grid, {});
  write("v.npy.json", good);
  EXPECT_TRUE(
      has(error_of([&] { import("v.npy"); }), "v.npy.json: window: does not hold all voxels"));
  const auto error_with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    write("v.npy.json", text.replace(at, from.size(), to));
    return error_of([&] { import("v.npy"); });
  };
  EXPECT_TRUE(has(error_with("\"resolution\": 32", "\"resolution\": 33"), "its grid cannot be"));
  EXPECT_TRUE(has(error_with("\"voxel_size\": 0.25", "\"voxel_size\": 0"), "its grid cannot be"));
  EXPECT_TRUE(has(error_with("\"origin\"", "\"other\""), "is no placement"));
  // Files of other programs are left alone.
  for (const char* other : {"{}", "[1, 2]", "no json", ""}) {
    write("v.npy.json", other);
    EXPECT_EQ(error_of([&] { import("v.npy"); }), "no error") << other;
  }
}

TEST_F(Places, AVolumeWithoutAPlaceTakesTheOneThatIsGiven) {
  const RandomVolume<std::uint8_t> volume({5, 3, 4}, 1);
  std::string header = "{'descr': '|u1', 'fortran_order': True, 'shape': (5, 3, 4), }";
  header.resize(117, ' ');
  std::string text("\x93NUMPY\x01\x00\x76\x00", 10);
  write("v.npy", text + header + "\n" + volume.bytes());
  EXPECT_FALSE(open("v.npy")->has_place());
  ImportOptions options;
  options.voxel_size = 0.05;
  options.origin = Vec3d{1, -2, 3};
  const ImportResult placed = import_with("v.npy", options);
  EXPECT_EQ(placed.grid.voxel_size, 0.05);
  EXPECT_EQ(placed.grid.origin, (Vec3d{1, -2, 3}));
  EXPECT_EQ(placed.dag, import("v.npy").dag);
}

/// Returns, for voxels in a volume whose axes lie along those of the world, the cubes of a side
/// that have their centres in one of them, by their world places.
std::map<VoxelKey, int> brute_cubes(const VolumePlacement& placement, const Grid& grid,
                                    const std::vector<Vec3i>& voxels) {
  std::map<VoxelKey, int> cubes;
  const int side = static_cast<int>(grid.resolution());
  for (const Vec3i v : voxels)
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const Vec3d centre = grid.to_world(Vec3d{x + 0.5, y + 0.5, z + 0.5});
          const Vec3d from_first = centre - *placement.first_centre;
          bool is_inside = true;
          for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d step = placement.steps[i];
            const double at = dot(from_first, step) / dot(step, step);
            is_inside &= std::abs(at - v[static_cast<int>(i)]) < 0.5;
          }
          if (is_inside) ++cubes[{x, y, z}];
        }
  return cubes;
}

TEST_F(Places, AxesAndBoxesOfAVolumeAreFollowed) {
  const VolumeSize size{3, 4, 2};
  const std::vector<Vec3i> voxels = {{0, 0, 0}, {2, 0, 1}, {1, 3, 0}, {2, 3, 1}};
  std::mt19937 rng(8);
  std::array<int, 3> axes{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs)
      for (const Vec3d spacing : {Vec3d{1, 1, 1}, Vec3d{1, 3, 2}, Vec3d{0.5, 0.7, 1.3}}) {
        VolumePlacement placement;
        placement.first_centre = Vec3d{7.25, -100.5, 3};
        for (std::size_t i = 0; i < 3; ++i) {
          placement.steps[i] = {};
          placement.steps[i][axes[i]] =
              (signs >> i & 1) != 0 ? -spacing[static_cast<int>(i)] : spacing[static_cast<int>(i)];
        }
        std::vector<std::string> warnings;
        const VolumeMap map("v", size, placement, warnings);
        EXPECT_EQ(warnings.size(), spacing.x == spacing.y ? 0u : 1u);
        EXPECT_EQ(map.grid().voxel_size, std::min({spacing.x, spacing.y, spacing.z}));
        std::vector<Vec3d> places;
        std::vector<Rgb8> colors;
        for (const Vec3i v : voxels) {
          places.push_back(static_cast<Vec3d>(v));
          colors.push_back({static_cast<std::uint8_t>(v.x), static_cast<std::uint8_t>(v.y), 9});
        }
        std::map<VoxelKey, int> found;
        map.visit_cubes({places, colors}, [&](const VoxelBatch& batch) {
          EXPECT_EQ(batch.colors.size(), batch.places.size());
          for (const Vec3d p : batch.places)
            ++found[{static_cast<int>(p.x), static_cast<int>(p.y), static_cast<int>(p.z)}];
        });
        EXPECT_EQ(found, brute_cubes(placement, map.grid(), voxels))
            << axes[0] << axes[1] << axes[2] << " " << signs << " " << spacing.y;
      }
  } while (std::next_permutation(axes.begin(), axes.end()));
}

}  // namespace
}  // namespace voxdag
