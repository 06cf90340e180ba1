// Tests view samples of meshes with appearances from their files.
#include <gtest/gtest.h>

#include <cmath>

#include "support/textured_square.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/mesh_view/mesh_view_source.hpp"

namespace voxdag {
namespace {

constexpr int kPictureSide = 16;

class MeshAppearanceTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!VOXDAG_HAS_EMBREE) GTEST_SKIP() << "built without Embree";
  }

  /// Returns the samples of a camera above the middle of the unit square; rows start at y = 1.
  static std::vector<ViewSample> look(const Square& square, double height = 0.5,
                                      double degrees = 90) {
    const MeshViewSource source(square.mesh, square.appearance, {});
    const Camera camera = make_camera({{0.5, 0.5, height}, {0.5, 0.5, 0}, {0, 1, 0}, degrees},
                                      kPictureSide, kPictureSide);
    std::vector<ViewSample> samples(kPictureSide * kPictureSide);
    source.sample(camera, {0, 0, kPictureSide, kPictureSide, 0, 0.5, 0.5}, samples);
    return samples;
  }
};

TEST_F(MeshAppearanceTest, ShowsItsTextureAndWhatIsBehindItsHoles) {
  Square square;
  // Red on the left, transparent on the right; a square of half blue is behind it.
  std::vector<std::uint16_t> texels;
  for (int i = 0; i < 16; ++i)
    texels.insert(texels.end(), {255, 0, 0, static_cast<std::uint16_t>(i % 4 < 2 ? 255 : 0)});
  square.material().color_map = square.texture("half.png", 4, 4, 4, texels);
  square.material().color_map.wrap_u = TextureWrap::kClamp;
  square.material().alpha_mode = AlphaMode::kMask;
  Material blue;
  blue.base_color = {0, 0, 0.5f};
  square.appearance.materials.push_back(blue);
  square.mesh.materials = {"half", "blue"};
  square.mesh.triangle_materials = {0, 0, 1};
  square.mesh.vertices.insert(square.mesh.vertices.end(),
                              {{-9, -9, -1}, {20, -9, -1}, {-9, 20, -1}});
  square.mesh.triangles.push_back({4, 5, 6});
  square.appearance.uvs.resize(9);

  const std::vector<ViewSample> samples = look(square);
  for (int y = 0; y < kPictureSide; ++y)
    for (int x = 0; x < kPictureSide; ++x) {
      const ViewSample& sample = samples[static_cast<std::size_t>(y * kPictureSide + x)];
      if (x == 7 || x == 8) continue;  // The hole's edge is somewhere between two texels.
      EXPECT_NEAR(sample.depth, x < 8 ? 0.5f : 1.5f, 1e-5f);
      EXPECT_NEAR(sample.albedo.x, x < 8 ? 1.0f : 0.0f, 1e-3f) << x;
      EXPECT_NEAR(sample.albedo.z, x < 8 ? 0.0f : 0.5f, 1e-3f) << x;
    }
}

TEST_F(MeshAppearanceTest, FiltersTexturesOverThePixel) {
  Square square;
  constexpr int kTexels = 256;
  square.material().color_map = square.noise(kTexels, 5);
  float least = 1, most = 0;
  for (const ViewSample& sample : look(square)) {
    least = std::min(least, sample.albedo.y);
    most = std::max(most, sample.albedo.y);
  }
  // The mean of 256 texels in linear light is 0.33, with a deviation of 0.29 / 16.
  EXPECT_GT(least, 0.2f);
  EXPECT_LT(most, 0.46f);
  EXPECT_GT(most - least, 0.02f);
}

TEST_F(MeshAppearanceTest, NormalsComeFromTheFileAndFaceTheViewer) {
  Square square;
  const Vec3f left = normalized(Vec3f{-1, 0, 2}), right = normalized(Vec3f{1, 0, 2});
  square.appearance.normals = {left, right, right, -left, -right, -left};
  const std::vector<ViewSample> samples = look(square);
  for (int y = 0; y < kPictureSide; ++y)
    for (int x = 0; x < kPictureSide; ++x) {
      const ViewSample& sample = samples[static_cast<std::size_t>(y * kPictureSide + x)];
      const float share = (static_cast<float>(x) + 0.5f) / kPictureSide;
      const Vec3f expected = normalized(left * (1 - share) + right * share);
      EXPECT_GT(dot(sample.normal, expected), 0.9999f) << x << ", " << y;
      EXPECT_EQ(sample.face, (Vec3f{0, 0, 1}));
      EXPECT_EQ(sample.albedo, MeshViewOptions{}.albedo);
    }
}

TEST_F(MeshAppearanceTest, ATextureThatCannotBeReadIsNamed) {
  Square square;
  square.material().name = "wall";
  square.appearance.images.push_back({"none.png", square.directory.path() / "none.png", {}});
  square.material().color_map.image = 0;
  std::vector<std::string> warnings;
  const MeshViewSource source(square.mesh, square.appearance, {}, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("none.png"), std::string::npos);
}

}  // namespace
}  // namespace voxdag
