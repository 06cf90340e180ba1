#include "voxdag/mesh/surface/surface_shading.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/textured_square.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

constexpr std::array<Vec2f, 3> kWhole{Vec2f{0, 0}, {1, 0}, {0, 1}};

/// Returns a convex polygon around a point of the triangle.
std::vector<Vec2f> polygon_around(Vec2f center, float size, std::mt19937& rng) {
  std::uniform_real_distribution<float> unit(0, 1);
  const auto corners = static_cast<int>(3 + rng() % 4);
  const float turn = 6.2831853f * unit(rng), flat = 0.3f + 0.7f * unit(rng);
  std::vector<Vec2f> polygon;
  for (int i = 0; i < corners; ++i) {
    const float angle = turn + 6.2831853f * (static_cast<float>(i) + 0.6f * unit(rng)) /
                                   static_cast<float>(corners);
    polygon.push_back(center + Vec2f{size * std::cos(angle), size * flat * std::sin(angle)});
  }
  return polygon;
}

/// Returns parts of a convex polygon: the triangles of its fan, each divided into four.
std::vector<std::array<Vec2f, 3>> subdivide(const std::vector<Vec2f>& polygon) {
  std::vector<std::array<Vec2f, 3>> parts;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Vec2f a = polygon[0], b = polygon[i - 1], c = polygon[i];
    const Vec2f ab = (a + b) * 0.5f, bc = (b + c) * 0.5f, ca = (c + a) * 0.5f;
    parts.insert(parts.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return parts;
}

float area_of(const std::array<Vec2f, 3>& t) { return std::abs(cross(t[1] - t[0], t[2] - t[0])); }

void expect_near(Vec3f a, Vec3f b, float error) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], error);
}

TEST(SurfaceShading, PlainMaterialsHaveTheirColourAndThePlanesNormal) {
  Square square;
  square.material().base_color = {0.1f, 0.2f, 0.3f};
  const SurfaceShading shading(square.mesh, square.appearance);
  const SurfaceSample sample = shading.mean(1, kWhole);
  EXPECT_EQ(sample.color, (Vec3f{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(sample.coverage, 1);
  EXPECT_EQ(sample.normal, (Vec3f{0, 0, 1}));
  EXPECT_TRUE(shading.is_uniform(1, kWhole, 0, 0, sample));
  EXPECT_FALSE(shading.may_be_alpha_masked(1));
  EXPECT_FALSE(shading.is_alpha_masked(1, kWhole));
}

TEST(SurfaceShading, TexturesStandUpright) {
  Square square;  // red, green / blue, white
  square.material().color_map =
      square.texture("a.png", 2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255});
  const SurfaceShading shading(square.mesh, square.appearance);
  const auto at = [&](float x, float y) {  // in the triangle that contains the point
    const bool lower = x > y;
    const std::array<Vec2f, 1> point{lower ? Vec2f{x - y, y} : Vec2f{x, y - x}};
    return shading.mean(lower ? 0 : 1, point).color;
  };
  expect_near(at(0.25f, 0.7501f), {1, 0, 0}, 1e-3f);
  expect_near(at(0.7501f, 0.75f), {0, 1, 0}, 1e-3f);
  expect_near(at(0.2501f, 0.25f), {0, 0, 1}, 1e-3f);
  expect_near(at(0.75f, 0.25f), {1, 1, 1}, 1e-3f);
}

TEST(SurfaceShading, AMeanIsTheMeanOfItsParts) {
  Square square;
  square.material().color_map = square.noise(256, 1);
  const SurfaceShading shading(square.mesh, square.appearance);
  std::mt19937 rng(2);
  std::uniform_real_distribution<float> unit(0.1f, 0.4f);
  for (const float size : {0.01f, 0.03f, 0.1f}) {
    double error = 0, error_of_parts = 0;
    constexpr int kCount = 60;
    for (int n = 0; n < kCount; ++n) {
      const auto polygon = polygon_around({unit(rng), unit(rng)}, size, rng);
      Vec3f parts{}, points{};
      float area = 0;
      for (const auto& part : subdivide(polygon)) {
        parts = parts + shading.mean(0, part).color * area_of(part);
        area += area_of(part);
        for (const Vec2f p : {part[0] * 0.6f + part[1] * 0.2f + part[2] * 0.2f,
                              part[0] * 0.2f + part[1] * 0.6f + part[2] * 0.2f,
                              part[0] * 0.2f + part[1] * 0.2f + part[2] * 0.6f}) {
          // Divides each part again, to sample many points.
          for (const auto& tiny : subdivide({part[0], part[1], part[2]}))
            for (const auto& dot : subdivide({tiny[0], tiny[1], tiny[2]})) {
              const std::array<Vec2f, 1> point{(dot[0] + dot[1] + dot[2]) * (1 / 3.0f) +
                                               (p - (part[0] + part[1] + part[2]) * (1 / 3.0f)) *
                                                   0.1f};
              points = points + shading.mean(0, point).color * (area_of(part) / 48);
            }
        }
      }
      const Vec3f mean = shading.mean(0, polygon).color;
      const Vec3f d = mean - parts * (1 / area), e = mean - points * (1 / area);
      error_of_parts += static_cast<double>(dot(d, d)) / 3;
      error += static_cast<double>(dot(e, e)) / 3;
    }
    // The texture is noise of standard deviation 0.3. The error is the filter's error at the
    // polygon's border.
    EXPECT_LT(std::sqrt(error_of_parts / kCount), size < 0.02f ? 0.06 : 0.03) << size;
    EXPECT_LT(std::sqrt(error / kCount), size < 0.02f ? 0.06 : 0.03) << size;
  }
}

TEST(SurfaceShading, ColoursAverageInLinearLight) {
  Square square;
  square.material().color_map = square.texture("a.png", 2, 1, 1, {0, 255});
  const SurfaceShading shading(square.mesh, square.appearance);
  const Vec3f both = shading.mean(0, kWhole).color + shading.mean(1, kWhole).color;
  EXPECT_NEAR(both.x / 2, 0.5f, 0.02f);
}

TEST(SurfaceShading, CoverageIsThePartThatPassesTheAlphaTest) {
  Square square;  // the left half is visible, and red
  square.material().color_map = square.texture("a.png", 64, 64, 4, [] {
    std::vector<std::uint16_t> samples;
    for (int x = 0; x < 64 * 64; ++x)
      for (const int s : {x % 64 < 32 ? 255 : 0, x % 64 < 32 ? 0 : 255, 0, x % 64 < 32 ? 200 : 100})
        samples.push_back(static_cast<std::uint16_t>(s));
    return samples;
  }());
  square.material().alpha_mode = AlphaMode::kMask;
  const SurfaceShading shading(square.mesh, square.appearance);
  EXPECT_TRUE(shading.may_be_alpha_masked(0));
  const SurfaceSample lower = shading.mean(0, kWhole), upper = shading.mean(1, kWhole);
  EXPECT_NEAR(lower.coverage, 0.25f, 0.09f);
  EXPECT_NEAR(upper.coverage, 0.75f, 0.09f);
  expect_near(lower.color, {1, 0, 0}, 1e-3f);  // the masked green has no effect
  const std::array<Vec2f, 3> left{Vec2f{0.1f, 0}, {0.3f, 0}, {0.2f, 0.1f}},
      right{Vec2f{0.7f, 0.1f}, {0.8f, 0}, {0.7f, 0.2f}};
  EXPECT_EQ(shading.mean(0, left).coverage, 1);
  EXPECT_TRUE(shading.is_uniform(0, left, 0.01f, 0.01f, shading.mean(0, left)));
  EXPECT_FALSE(shading.is_alpha_masked(0, left));
  EXPECT_EQ(shading.mean(0, right).coverage, 0);
  expect_near(shading.mean(0, right).color, {1, 0, 0}, 1e-3f);  // the nearest visible colour
  EXPECT_TRUE(shading.is_alpha_masked(0, right));
  EXPECT_TRUE(shading.is_uniform(0, right, 0.01f, 0.01f, shading.mean(0, right)));
  EXPECT_FALSE(shading.is_uniform(0, kWhole, 1, 1, lower));
}

TEST(SurfaceShading, AnOpaqueAlphaChannelIsNone) {
  Square square;
  square.material().base_color = {1, 0, 0};
  square.material().alpha_map = square.texture("a.png", 1, 1, 4, {0, 0, 0, 255});
  square.material().alpha_mode = AlphaMode::kMask;
  EXPECT_EQ(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).coverage, 0);
}

TEST(SurfaceShading, AnImpliedMaskDoesNotHideAWholeTexture) {
  Square square;
  square.material().color_map = square.texture("a.png", 1, 1, 4, {255, 0, 0, 0});
  square.material().alpha_mode = AlphaMode::kImpliedMask;
  std::vector<std::string> warnings;
  const SurfaceShading shading(square.mesh, square.appearance, &warnings);
  EXPECT_EQ(shading.mean(0, kWhole).coverage, 1);
  expect_near(shading.mean(0, kWhole).color, {1, 0, 0}, 1e-3f);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("it is opaque"), std::string::npos);
  square.material().alpha_mode = AlphaMode::kMask;
  EXPECT_EQ(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).coverage, 0);
}

TEST(SurfaceShading, EmissionIsAdded) {
  Square square;
  square.material().base_color = {0.25f, 0.5f, 0};
  square.material().emission = {0.5f, 1, 0.5f};
  expect_near(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).color,
              {0.75f, 1, 0.5f}, 1e-3f);
  square.material().emission_map = square.texture("a.png", 1, 1, 3, {255, 0, 255});
  const SurfaceShading shading(square.mesh, square.appearance);
  const SurfaceSample sample = shading.mean(0, kWhole);
  expect_near(sample.color, {0.75f, 0.5f, 0.5f}, 1e-3f);
  EXPECT_TRUE(shading.is_uniform(0, kWhole, 0.01f, 0.01f, sample));
  square.appearance.images[0].path = "missing.png";
  expect_near(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).color,
              {0.25f, 0.5f, 0}, 1e-3f);
}

TEST(SurfaceShading, MaterialsAndCornersMayBeWhollyTransparent) {
  Square square;
  square.material().alpha = 0.05f;
  square.material().alpha_mode = AlphaMode::kBlend;
  const SurfaceShading gone(square.mesh, square.appearance);
  EXPECT_TRUE(gone.is_alpha_masked(0, kWhole));
  EXPECT_EQ(gone.mean(0, kWhole).coverage, 0);
  square.material().alpha = 1;
  square.appearance.colors.assign(6, {});
  for (std::size_t c = 0; c < 3; ++c) square.appearance.colors[c].a = 0;
  const SurfaceShading half(square.mesh, square.appearance);
  EXPECT_TRUE(half.is_alpha_masked(0, kWhole));
  EXPECT_FALSE(half.is_alpha_masked(1, kWhole));
  EXPECT_EQ(half.mean(1, kWhole).coverage, 1);
}

TEST(SurfaceShading, CornerColoursAndNormalsAreInterpolated) {
  Square square;
  square.appearance.colors.assign(6, to_rgba16({0.5f, 0.5f, 0.5f}, 1));
  square.appearance.colors[1] = to_rgba16({1, 0, 0}, 1);
  square.appearance.normals.assign(6, {0, 0, 1});
  square.appearance.normals[1] = {1, 0, 0};
  const SurfaceShading shading(square.mesh, square.appearance);
  const std::array<Vec2f, 1> middle{Vec2f{0.5f, 0}};
  const SurfaceSample sample = shading.mean(0, middle);
  expect_near(sample.color, {0.75f, 0.25f, 0.25f}, 1e-4f);
  expect_near(sample.normal, {std::sqrt(0.5f), 0, std::sqrt(0.5f)}, 1e-4f);
  // The mean of different normals is shorter than 1. Compares it with the mean of many samples.
  Vec3f sum{};
  constexpr int kSide = 200;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; i + j < kSide; ++j) {
      const std::array<Vec2f, 1> point{
          Vec2f{(static_cast<float>(i) + 0.33f) / kSide, (static_cast<float>(j) + 0.33f) / kSide}};
      sum = sum + shading.mean(0, point).normal;
    }
  expect_near(shading.mean(0, kWhole).normal, sum * (2.0f / (kSide * (kSide + 1))), 0.03f);
}

TEST(SurfaceShading, NormalMapsFollowTheAxesOfTheImage) {
  // Red tilts normals to the right of the image, green to its upper edge.
  Square square;
  square.material().normal_map = square.texture("n.png", 1, 1, 3, {218, 128, 218});
  expect_near(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).normal,
              {0.707f, 0, 0.707f}, 0.01f);
  square.material().normal_map = square.texture("n2.png", 1, 1, 3, {128, 218, 218});
  expect_near(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).normal,
              {0, 0.707f, 0.707f}, 0.01f);
  // Mirrored: the image's right is the square's left.
  for (Vec2f& uv : square.appearance.uvs) uv.x = 1 - uv.x;
  expect_near(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).normal,
              {0, 0.707f, 0.707f}, 0.01f);
  square.material().normal_map.image = 0;
  expect_near(SurfaceShading(square.mesh, square.appearance).mean(0, kWhole).normal,
              {-0.707f, 0, 0.707f}, 0.01f);
}

TEST(SurfaceShading, TangentsFollowTheSurfaceNotTheTriangles) {
  // A bent strip: the tangent at the bend is the mean of the tangents of both sides.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, -1}, {1, 1, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  Appearance appearance;
  const float r = std::sqrt(0.5f);
  const std::array<Vec3f, 6> normals{Vec3f{0, 0, 1}, {r, 0, r}, {r, 0, r},
                                     {0, 0, 1},      {1, 0, 0}, {1, 0, 0}};
  const std::array<Vec2f, 6> uvs{Vec2f{0, 1}, {1, 1}, {1, 0}, {0, 0}, {2, 1}, {2, 0}};
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      appearance.normals.push_back(normals[v]);
      appearance.uvs.push_back(uvs[v]);
    }
  const TempDir directory;
  write_test_png(directory.path() / "n.png", 1, 1, 3, 8, {255, 128, 128});
  appearance.images.push_back({"n.png", directory.path() / "n.png", {}});
  appearance.materials.resize(1);
  appearance.materials[0].normal_map.image = 0;
  const SurfaceShading shading(mesh, appearance);
  const std::array<Vec2f, 1> at_bend{Vec2f{1, 0}};
  expect_near(shading.mean(0, at_bend).normal, {r, 0, -r}, 0.02f);
}

TEST(SurfaceShading, UniformMeansThatEveryPointIsNearTheMean) {
  Square square;
  // Smooth enough that some polygons are uniform.
  std::vector<std::uint16_t> colors, normals;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      for (const int s : {100 + x, 100 + (x * y) / 64, 180 + y / 2})
        colors.push_back(static_cast<std::uint16_t>(s));
      for (const int s : {128 + x / 2, 128 - y / 2, 240})
        normals.push_back(static_cast<std::uint16_t>(s));
    }
  square.material().color_map = square.texture("c.png", 64, 64, 3, colors);
  square.material().normal_map = square.texture("n.png", 64, 64, 3, normals);
  square.appearance.normals.assign(6, {0, 0, 1});
  square.appearance.normals[1] = {0.6f, 0, 0.8f};
  const SurfaceShading shading(square.mesh, square.appearance);
  std::mt19937 rng(9);
  std::uniform_real_distribution<float> unit(0, 1);
  constexpr float kColorError = 0.03f, kNormalError = 0.1f;
  int uniform = 0;
  for (int n = 0; n < 500; ++n) {
    const auto polygon = polygon_around({0.2f + 0.2f * unit(rng), 0.2f + 0.2f * unit(rng)},
                                        0.2f * unit(rng) * unit(rng), rng);
    const SurfaceSample mean = shading.mean(0, polygon);
    if (!shading.is_uniform(0, polygon, kColorError, kNormalError, mean)) continue;
    ++uniform;
    for (int k = 0; k < 40; ++k) {
      Vec2f p{};
      float sum = 0;
      for (const Vec2f corner : polygon) {
        const float weight = -std::log(unit(rng) + 1e-6f);
        p = p + corner * weight;
        sum += weight;
      }
      const std::array<Vec2f, 1> point{p * (1 / sum)};
      const SurfaceSample sample = shading.mean(0, point);
      for (int c = 0; c < 3; ++c)
        EXPECT_LE(std::abs(linear_to_srgb(sample.color[c]) - linear_to_srgb(mean.color[c])),
                  kColorError + 1e-3f);
      const float cosine =
          dot(sample.normal, mean.normal) /
          std::sqrt(dot(sample.normal, sample.normal) * dot(mean.normal, mean.normal));
      EXPECT_LE(std::acos(std::min(cosine, 1.0f)), kNormalError + 1e-3f);
    }
  }
  EXPECT_GT(uniform, 100);
  EXPECT_LT(uniform, 450);
}

TEST(SurfaceShading, MissingTexturesAreWarningsThatNameTheReplacement) {
  Square square;
  square.material().base_color = {0.2f, 0.4f, 0.6f};
  const auto path = square.directory.path() / "no.png";
  square.appearance.images.push_back({path.string(), path, {}});
  square.appearance.images.push_back({"mesh.glb: images[1]", {}, {1, 2, 3}});
  square.material().color_map.image = 0;
  square.material().normal_map.image = 1;
  std::vector<std::string> warnings;
  const SurfaceShading shading(square.mesh, square.appearance, &warnings);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0], path.string() +
                             ": cannot open: No such file or directory: the material's "
                             "colour replaces the texture");
  EXPECT_EQ(warnings[1],
            "mesh.glb: images[1]: byte 0: not an image: PNG, JPEG, WebP, BMP and TGA images are "
            "read: the "
            "mesh's own normals "
            "replace the normal map");
  EXPECT_EQ(shading.mean(0, kWhole).color, (Vec3f{0.2f, 0.4f, 0.6f}));
  EXPECT_EQ(shading.mean(0, kWhole).normal, (Vec3f{0, 0, 1}));
}

TEST(SurfaceShading, ManyMissingTexturesAreFewWarnings) {
  Square square;
  square.appearance.materials.resize(20);
  for (int i = 0; i < 20; ++i) {
    const auto path = square.directory.path() / ("missing" + std::to_string(i) + ".png");
    square.appearance.images.push_back({path.string(), path, {}});
    square.appearance.materials[static_cast<std::size_t>(i)].color_map.image = i;
  }
  std::vector<std::string> warnings;
  const SurfaceShading shading(square.mesh, square.appearance, &warnings);
  ASSERT_EQ(warnings.size(), 9u);
  EXPECT_EQ(warnings.back(), "there are 12 more warnings about textures");
}

TEST(SurfaceShading, MaterialsShareTheirTextures) {
  Square square;
  square.material().color_map = square.noise(64, 4);
  square.appearance.materials.resize(2, square.material());
  const std::uint64_t shared = SurfaceShading(square.mesh, square.appearance).bytes();
  square.appearance.materials[1].color_map.wrap_u = TextureWrap::kClamp;
  EXPECT_EQ(SurfaceShading(square.mesh, square.appearance).bytes(), 2 * shared);
}

TEST(SurfaceShading, DegenerateTrianglesAndPolygonsAreHarmless) {
  Square square;
  square.mesh.triangles.push_back({0, 0, 1});
  square.appearance.uvs.resize(9);
  square.material().color_map = square.noise(16, 3);
  square.material().normal_map = square.material().color_map;
  const SurfaceShading shading(square.mesh, square.appearance);
  for (std::uint32_t t = 0; t < 3; ++t)
    for (const std::size_t corners : {1u, 2u, 3u}) {
      const std::array<Vec2f, 3> polygon{Vec2f{0.5f, 0.5f}, {0.5f, 0.5f}, {0.25f, 0.25f}};
      const SurfaceSample sample = shading.mean(t, std::span(polygon).first(corners));
      EXPECT_TRUE(sample.color.x >= 0 && sample.color.x <= 1);
      EXPECT_TRUE(std::isfinite(sample.normal.x));
      shading.is_uniform(t, std::span(polygon).first(corners), 0.1f, 0.1f, sample);
    }
}

}  // namespace
}  // namespace voxdag
