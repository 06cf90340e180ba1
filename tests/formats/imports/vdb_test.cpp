// Grids of OpenVDB, which OpenVDB writes, against voxels computed one by one.
#if VOXDAG_HAS_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>
#endif

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "support/brute_svdag.hpp"
#include "volume_files.hpp"

namespace voxdag {
namespace {

class Vdb : public VolumeTest {};

#if VOXDAG_HAS_OPENVDB

bool is_less(Vec3i a, Vec3i b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
std::vector<Vec3i> sorted(std::vector<Vec3i> voxels) {
  std::sort(voxels.begin(), voxels.end(), is_less);
  return voxels;
}

/// Writes grids to a file.
void write_grids(const std::string& path, const std::vector<openvdb::GridBase::Ptr>& grids) {
  openvdb::io::File(path).write(openvdb::GridCPtrVec(grids.begin(), grids.end()));
}

template <class GridType>
class VdbOf : public Vdb {};
using GridTypes = testing::Types<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                 openvdb::Int64Grid, openvdb::BoolGrid>;
TYPED_TEST_SUITE(VdbOf, GridTypes);

TYPED_TEST(VdbOf, ActiveVoxelsAreSet) {
  using Value = typename TypeParam::ValueType;
  openvdb::initialize();
  const auto grid = TypeParam::create();
  std::mt19937 rng(4);
  std::vector<Vec3i> active, at_least_1;
  for (int i = 0; i < 300; ++i) {
    const Vec3i v{static_cast<int>(rng() % 40), static_cast<int>(rng() % 20),
                  static_cast<int>(rng() % 30)};
    const openvdb::Coord at(v.x - 25, v.y + 100, v.z - 7);
    if (grid->tree().isValueOn(at)) continue;
    const auto value = static_cast<Value>(static_cast<int>(rng() % 2));
    if (rng() % 4 == 0) {
      grid->tree().setValueOff(at, static_cast<Value>(1));
      continue;
    }
    grid->tree().setValueOn(at, value);
    active.push_back(v);
    if (value >= 1) at_least_1.push_back(v);
  }
  // Corners fix the extent, so that a threshold does not move it.
  for (const Vec3i v : {Vec3i{0, 0, 0}, Vec3i{40, 20, 30}}) {
    const openvdb::Coord at(v.x - 25, v.y + 100, v.z - 7);
    std::erase(active, v);
    std::erase(at_least_1, v);
    grid->tree().setValueOn(at, static_cast<Value>(1));
    active.push_back(v);
    at_least_1.push_back(v);
  }
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  write_grids(this->path("v.vdb"), {grid});
  EXPECT_EQ(sorted(this->read("v.vdb").voxels), sorted(active));
  EXPECT_EQ(this->import("v.vdb").dag, brute_svdag(6, active));
  EXPECT_EQ(sorted(this->read("v.vdb", 1.0).voxels), sorted(at_least_1));
  EXPECT_EQ(this->open("v.vdb")->grid()->voxel_size, 0.5);
  EXPECT_EQ(this->open("v.vdb")->grid()->origin, (Vec3d{-12.75, 49.75, -3.75}));
  EXPECT_TRUE(this->open("v.vdb")->warnings().empty());
}

TYPED_TEST(VdbOf, ValuesAreLabelsAndChannels) {
  using Value = typename TypeParam::ValueType;
  openvdb::initialize();
  const auto grid = TypeParam::create();
  const auto heat = openvdb::FloatGrid::create(-7), far = openvdb::FloatGrid::create();
  grid->setName("organ");
  heat->setName("heat");
  far->setName("far");
  far->setTransform(openvdb::math::Transform::createLinearTransform(2));
  std::mt19937 rng(5);
  std::map<std::tuple<int, int, int>, std::array<double, 2>> expected;
  // The tile is a cube of 8 voxels, of which some have heat.
  grid->tree().addTile(1, openvdb::Coord(8, 0, 0), static_cast<Value>(1), true);
  for (int i = 0; i < 512; ++i) expected[{8 + i / 64, i / 8 % 8, i % 8}] = {1, -7};
  grid->tree().setValueOn(openvdb::Coord(0, 0, 0), static_cast<Value>(1));
  expected[{0, 0, 0}] = {1, -7};
  for (int i = 0; i < 200; ++i) {
    const auto at = [&] { return static_cast<int>(rng() % 8); };
    const openvdb::Coord place(at(), at(), at()), hot(8 + at(), at(), at());
    const auto value = static_cast<Value>(static_cast<int>(rng() % 5));
    grid->tree().setValueOn(place, value);
    expected[{place.x(), place.y(), place.z()}] = {static_cast<double>(value), -7};
    heat->tree().setValueOn(hot, static_cast<float>(i));
    expected[{hot.x(), hot.y(), hot.z()}][1] = i;
  }
  write_grids(this->path("v.vdb"), {grid, heat, far});
  const std::vector<ChannelRequest> wanted{{"Heat", {}}, {"value", {}}};
  const VoxelSourceOptions options{.grid = "organ", .labels = "", .channels = wanted};
  const SourceVoxels found = this->read_with("v.vdb", options);
  ASSERT_EQ(found.voxels.size(), expected.size());
  for (std::size_t i = 0; i < found.voxels.size(); ++i) {
    const Vec3i v = found.voxels[i];
    const std::array<double, 2> values = expected.at({v.x, v.y, v.z});
    EXPECT_EQ(found.labels[i], static_cast<Label>(values[0]));
    EXPECT_EQ(found.channels[2 * i], values[1]);
    EXPECT_EQ(found.channels[2 * i + 1], values[0]);
  }
  const auto source = open_voxel_source(this->path("v.vdb"), options);
  EXPECT_EQ(source->channels()[0].kind, ChannelKind::kF32);
  constexpr bool kIsReal = std::is_floating_point_v<Value>, kIsBool = sizeof(Value) == 1;
  EXPECT_EQ(source->channels()[1].kind,
            kIsReal ? ChannelKind::kF32 : (kIsBool ? ChannelKind::kU8 : ChannelKind::kI32));
  const auto error = [&](const VoxelSourceOptions& others) {
    return error_of([&] { this->read_with("v.vdb", others); });
  };
  EXPECT_TRUE(this->has(error({.grid = "organ", .channels = {{"far", {}}}}),
                        "grid 'far' has another transform than 'organ'"));
  EXPECT_TRUE(this->has(error({.grid = "organ", .channels = {{"cold", {}}}}),
                        "has no field 'cold'; its fields are far, heat, organ"));
  EXPECT_TRUE(this->has(error({.grid = "organ", .labels = "heat"}),
                        "has no fields, of which 'heat' could have labels"));
}

TEST_F(Vdb, LabelsAreWholeAndBoxesKeepAllChannels) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(), other = openvdb::FloatGrid::create(3);
  grid->setName("density");
  other->setName("other");
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();
  matrix[1][1] = 3;  // Each voxel becomes three cubes.
  for (const auto& of : {grid, other})
    of->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  grid->tree().setValueOn(openvdb::Coord(0, 0, 0), 2);
  write_grids(path("v.vdb"), {grid, other});
  EXPECT_EQ(
      read_with("v.vdb", {.labels = "", .channels = {{"other", {}}, {"density", {}}}}).channels,
      (std::vector<double>{3, 2, 3, 2, 3, 2}));
  EXPECT_EQ(read_with("v.vdb", {.labels = ""}).labels, (std::vector<Label>{2, 2, 2}));
  grid->tree().setValueOn(openvdb::Coord(0, 0, 0), 2.5);
  write_grids(path("v.vdb"), {grid});
  EXPECT_TRUE(has(error_of([&] { read_with("v.vdb", {.labels = ""}); }), "has the label 2.5"));
}

TEST_F(Vdb, LevelSetsAreFilled) {
  openvdb::initialize();
  const double radius = 20.3;
  // The inside has tiles: 8 voxels a side.
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      static_cast<float>(radius), openvdb::Vec3f(0, 0, 0), 1.0F, 3.0F);
  write_grids(path("v.vdb"), {sphere});
  std::vector<Vec3i> inside;
  for (int x = -20; x <= 20; ++x)
    for (int y = -20; y <= 20; ++y)
      for (int z = -20; z <= 20; ++z)
        if (x * x + y * y + z * z < radius * radius) inside.push_back({x + 20, y + 20, z + 20});
  EXPECT_EQ(sorted(read("v.vdb").voxels), sorted(inside));
  EXPECT_EQ(open("v.vdb")->grid()->origin, (Vec3d{-20.5, -20.5, -20.5}));
  // With a threshold, only the active voxels are compared: those of the narrow band.
  std::size_t band = 0;
  for (auto value = sphere->cbeginValueOn(); value; ++value) band += *value >= -1.5F ? 1 : 0;
  EXPECT_EQ(read("v.vdb", -1.5).voxels.size(), band);
}

TEST_F(Vdb, TilesSetAllTheirVoxels) {
  openvdb::initialize();
  const auto mask = openvdb::MaskGrid::create();
  mask->tree().addTile(1, openvdb::Coord(8, 0, 0), true, true);
  mask->tree().setValueOn(openvdb::Coord(0, 1, 2));
  write_grids(path("v.vdb"), {openvdb::Vec3SGrid::create(), mask});
  std::vector<Vec3i> expected = {{0, 1, 2}};
  for (int x = 8; x < 16; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z) expected.push_back({x, y, z});
  EXPECT_EQ(sorted(read("v.vdb").voxels), sorted(expected)) << "the first grid has vectors";
}

TEST_F(Vdb, OtherTransformsAreWarnedOf) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create();
  grid->tree().setValueOn(openvdb::Coord(1, 2, 3), 1);
  const auto warning_of = [&](const openvdb::Mat4R& matrix) {
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    write_grids(path("v.vdb"), {grid});
    const auto source = open("v.vdb");
    return source->warnings().empty() ? std::string() : source->warnings()[0];
  };
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();
  EXPECT_EQ(warning_of(matrix), "");
  matrix[1][1] = 3;
  EXPECT_TRUE(has(warning_of(matrix), "boxes of 1 x 3 x 1"));
  matrix = openvdb::Mat4R(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  EXPECT_EQ(warning_of(matrix), "") << "quarter turns are exact";
  matrix = openvdb::Mat4R(0.8, 0.6, 0.0, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0,
                          0.0, 1.0);
  EXPECT_TRUE(has(warning_of(matrix), "turns or shears"));
}

TEST_F(Vdb, OtherFilesAreRefused) {
  openvdb::initialize();
  EXPECT_TRUE(has(error_of_bytes("v.vdb", "no VDB"), "OpenVDB: "));
  EXPECT_TRUE(has(error_of([&] { open("none.vdb"); }), "cannot open"));
  write_grids(path("v.vdb"), {openvdb::Vec3SGrid::create()});
  EXPECT_TRUE(has(error_of([&] { open("v.vdb"); }), "has no grid of floats"));
  const auto grid = openvdb::FloatGrid::create();
  write_grids(path("v.vdb"), {grid});
  EXPECT_EQ(import("v.vdb").read, 0u);
  grid->tree().setValueOn(openvdb::Coord(0, 0, 0), 1);
  grid->tree().setValueOn(openvdb::Coord(1 << 20, 0, 0), 1);
  write_grids(path("v.vdb"), {grid});
  EXPECT_TRUE(has(error_of([&] { open("v.vdb"); }), "has 1048577 voxels"));
}

#else

TEST_F(Vdb, FilesAreRefusedWithoutOpenVdb) {
  EXPECT_TRUE(has(error_of_bytes("v.vdb", ""), "is built where OpenVDB is installed"));
}

#endif

}  // namespace
}  // namespace voxdag
