#include "voxdag/formats/scenes/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <ostream>
#include <string>

#include "mesh_facts.hpp"
#include "voxdag/core/box.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {

void PrintTo(const SceneInfo& scene, std::ostream* out) { *out << scene.name; }

namespace {

struct SmallScene {
  std::string_view name;
  double size;
  std::uint64_t hash;  ///< Hash for seed 1, on every machine.
};

/// Small sizes that are generated in much less than a second. If a scene is changed on purpose, its
/// hash must be changed here.
constexpr SmallScene kSmall[] = {
    {"city", 1, 0x53f8789889480855},      {"courtyard", 0.4, 0x1b8e25bd4cc4ecc},
    {"hairball", 20, 0x3e682f539f47fcc1}, {"sponge", 2, 0x48f77797a24deb0},
    {"terrain", 64, 0xf05a02a278f91509},
};

const SmallScene& small_scene(std::string_view name) {
  return *std::find_if(std::begin(kSmall), std::end(kSmall),
                       [&](const SmallScene& scene) { return scene.name == name; });
}

SceneOptions small(std::string_view name) { return {small_scene(name).size, 1}; }

class Scenes : public testing::TestWithParam<SceneInfo> {
 protected:
  std::string_view name() const { return GetParam().name; }
  Mesh mesh() const { return make_scene(name(), small(name())); }
};

TEST_P(Scenes, IndicesVerticesAndMaterialsAreSane) { EXPECT_TRUE(is_sane(mesh())); }

TEST_P(Scenes, NoTriangleIsDegenerate) { EXPECT_EQ(degenerate_count(mesh()), 0u); }

TEST_P(Scenes, SeedAndSizeGiveTheSameBytesEverywhere) {
  EXPECT_EQ(hash_of(mesh()), small_scene(name()).hash) << std::hex << hash_of(mesh());
}

TEST_P(Scenes, AnotherSeedGivesAnotherMeshExceptOfTheOneSponge) {
  SceneOptions options = small(name());
  options.seed = 2;
  EXPECT_EQ(hash_of(make_scene(name(), options)) == hash_of(mesh()), name() == "sponge");
}

TEST_P(Scenes, ALargerSizeHasMoreTriangles) {
  SceneOptions options = small(name());
  options.size *= 2;
  EXPECT_GT(make_scene(name(), options).triangles.size(), mesh().triangles.size());
}

TEST_P(Scenes, SizesOutsideTheRangeAreRefused) {
  for (const double size : {GetParam().max_size * 2, -1.0, 1e300, 0.0 / 0.0}) {
    SceneOptions options;
    options.size = size;
    EXPECT_THROW(make_scene(name(), options), Error) << size;
    EXPECT_THROW(scene_preset(name(), options), Error) << size;
  }
}

TEST_P(Scenes, ThePresetLooksAtTheScene) {
  const Mesh scene = mesh();
  const ScenePreset preset = scene_preset(name(), small(name()));
  Box3f bounds = Box3f::empty();
  for (const Vec3f& v : scene.vertices) bounds.extend(v);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(preset.target[axis], bounds.lo[axis]);
    EXPECT_LE(preset.target[axis], bounds.hi[axis]);
  }
  EXPECT_NEAR(dot(preset.sun_direction, preset.sun_direction), 1, 1e-9);
  EXPECT_NE(preset.eye, preset.target);
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scene_list().begin(), scene_list().end()),
                         [](const auto& scene) { return std::string(scene.param.name); });

TEST(SceneList, IsSortedByName) {
  EXPECT_TRUE(std::is_sorted(scene_list().begin(), scene_list().end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
}

TEST(SceneList, AnUnknownNameIsAnErrorThatNamesTheOthers) {
  try {
    make_scene("teapot");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("hairball"), std::string::npos);
  }
}

TEST(Hairball, HasItsPublishedNumberOfTriangles) {
  EXPECT_EQ(make_scene("hairball").triangles.size(), 2'880'000u);
}

TEST(Hairball, HairsAreClosedTubesInsideTheUnitBall) {
  const Mesh mesh = make_scene("hairball", small("hairball"));
  EXPECT_EQ(mesh.triangles.size(), 20u * 1440u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_GT(signed_volume(mesh), 0);
  for (const Vec3f& v : mesh.vertices) EXPECT_LE(dot(v, v), 1.0f);
}

TEST(Sponge, FacesAndVolumeAreTheAnalyticOnes) {
  std::size_t cubes = 1, eights = 1;
  for (int depth = 1; depth <= 4; ++depth) {
    cubes *= 20;
    eights *= 8;
    SceneOptions options;
    options.size = depth;
    const Mesh mesh = make_scene("sponge", options);
    // 20^n cubes have 2 * 20^n + 4 * 8^n outer faces.
    EXPECT_EQ(mesh.triangles.size(), 2 * (2 * cubes + 4 * eights));
    EXPECT_TRUE(is_closed(mesh));
    const double cell = 1.0 / (depth == 1 ? 4 : depth == 2 ? 16 : depth == 3 ? 32 : 128);
    EXPECT_EQ(signed_volume(mesh), static_cast<double>(cubes) * cell * cell * cell);
  }
}

}  // namespace
}  // namespace voxdag
