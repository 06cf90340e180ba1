// Pictures of surfaces with the channels metallic and roughness.
#include <gtest/gtest.h>

#include "cpu/effect_scenes.hpp"
#include "support/mirror_attributes.hpp"
#include "support/picture_checks.hpp"
#include "support/with_threads.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"

namespace voxdag {
namespace {

using Numbers = std::array<std::uint8_t, 2>;

class MirrorPictures : public testing::Test {
 protected:
  MirrorPictures() {
    options_ = small_picture();
    options_.with_normal = options_.with_occlusion = true;
  }

  DagAttributes attributes(Value8 color, bool with_channels, Numbers numbers) const {
    return mirror_attributes(ball_.view(), color, with_channels,
                             [numbers](std::uint64_t) { return numbers; });
  }
  RenderedImage picture(const DagAttributes& of) const {
    RenderOptions options = options_;
    options.look = ColoredDagView{ball_.view(), of.view()};
    return render_image(ball_.view(), test_grid(6), options);
  }
  /// Light of radiance 1 from everywhere.
  void light_from_everywhere() {
    options_.with_sun = false;
    options_.environment = std::make_shared<Environment>(32, [](Vec3f) { return Vec3f{1, 1, 1}; });
  }

  static constexpr Value8 kWhite{255, 255, 255};
  Svdag ball_ = dag_where(6, [](int x, int y, int z) {
    const Vec3i to{2 * x - 63, 2 * y - 63, 2 * z - 63};
    return dot(to, to) < 60 * 60;
  });
  RenderOptions options_;
};

TEST_F(MirrorPictures, WithoutTheChannelsTheOptionChangesNothing) {
  const DagAttributes plain = attributes({200, 90, 30}, false, {});
  const DagAttributes dull = attributes({200, 90, 30}, true, {0, 255});
  const DagAttributes metal = attributes({200, 90, 30}, true, {255, 80});
  const RenderedImage expected = picture(plain);
  test::expect_same_picture(picture(dull), expected);
  EXPECT_NE(picture(metal).rgb, expected.rgb);
  options_.reflections = false;
  test::expect_same_picture(picture(plain), expected);
  test::expect_same_picture(picture(metal), expected);
}

TEST_F(MirrorPictures, WithoutTheChannelsPathsDoNotChange) {
  options_.bounces = 2;
  const RenderedImage expected = picture(attributes({200, 90, 30}, false, {}));
  test::expect_same_picture(picture(attributes({200, 90, 30}, true, {0, 255})), expected);
  options_.reflections = false;
  test::expect_same_picture(picture(attributes({200, 90, 30}, true, {255, 80})), expected);
}

TEST_F(MirrorPictures, InAWhiteFurnaceWhiteSurfacesAreEquallyBrightWhateverTheirNumbers) {
  light_from_everywhere();
  for (const int occlusion : {4, 0}) {
    options_.occlusion_samples = occlusion;
    const RenderedImage diffuse = picture(attributes(kWhite, false, {}));
    for (const Numbers numbers :
         {Numbers{255, 0}, Numbers{255, 255}, Numbers{0, 60}, Numbers{100, 128}}) {
      const RenderedImage mirrored = picture(attributes(kWhite, true, numbers));
      for (std::size_t i = 0; i < diffuse.radiance.size(); ++i)
        ASSERT_NEAR(mirrored.radiance[i].y, diffuse.radiance[i].y, 2e-3f)
            << int{numbers[0]} << " " << int{numbers[1]};
    }
  }
}

TEST_F(MirrorPictures, NoSurfaceReflectsMoreLightThanArrives) {
  light_from_everywhere();
  for (const Numbers numbers : {Numbers{255, 20}, Numbers{0, 20}, Numbers{128, 200}})
    for (const Vec3f radiance : picture(attributes({250, 120, 10}, true, numbers)).radiance)
      for (int c = 0; c < 3; ++c) ASSERT_LE(radiance[c], 1.001f);
}

/// The metal's colour tints what it mirrors, and the ball shows the sky at the mirrored places.
TEST_F(MirrorPictures, AMetalBallMirrorsTheSky) {
  options_.with_sun = false;
  options_.occlusion_samples = 4;
  options_.environment = std::make_shared<Environment>(128, [](Vec3f d) {
    return Vec3f{0.2f + (d.x > 0 ? 1 : 0), 0.2f + (d.y > 0 ? 1 : 0), 1};
  });
  const Value8 color{255, 128, 0};
  const RenderedImage image = picture(attributes(color, true, {255, 0}));
  const Camera camera = make_camera(image.view, image.width, image.height);
  const SkyMap map = options_.environment->map(static_cast<Vec3f>(image.view.up));
  int compared = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.width + x);
      const Vec3f normal = image.normal[i];
      const auto view = static_cast<Vec3f>(normalized(camera.direction(x + 0.5, y + 0.5)));
      // Where the normal turns away, the rule takes another line of sight.
      if (normal == Vec3f{} || dot(normal, view) > -0.3f) continue;
      const Vec3f mirrored = view - normal * (2 * dot(normal, view));
      // Places where the sky's colours change.
      if (std::fabs(dot(mirrored, map.right)) < 0.05f || std::fabs(dot(mirrored, map.up)) < 0.05f)
        continue;
      ++compared;
      const Vec3f sky = map_radiance(map, mirrored) * (0.7f * image.occlusion[i]);
      const float rest = 1 + dot(normal, view), schlick = std::pow(rest, 5.0f);
      for (int c = 0; c < 3; ++c) {
        const float f0 = srgb_to_linear(static_cast<float>(color[c]) / 255);
        ASSERT_NEAR(image.radiance[i][c], sky[c] * (f0 + (1 - f0) * schlick), 2e-3f);
      }
    }
  EXPECT_GT(compared, 400);
}

TEST_F(MirrorPictures, ASmoothSurfaceHasASmallerAndBrighterHighlightThanARoughOne) {
  options_.sky = 0;
  options_.sun = {0.3, 0.8, 0.5};
  const auto brightest = [&](Numbers numbers) {
    float most = 0;
    int bright = 0;
    const RenderedImage image = picture(attributes({0, 0, 0}, true, numbers));
    for (const Vec3f radiance : image.radiance) most = std::max(most, radiance.y);
    for (const Vec3f radiance : image.radiance) bright += radiance.y > most / 2 ? 1 : 0;
    return std::pair{most, bright};
  };
  const auto [smooth, smooth_pixels] = brightest({0, 80});
  const auto [rough, rough_pixels] = brightest({0, 200});
  EXPECT_GT(smooth, 2 * rough);
  EXPECT_LT(2 * smooth_pixels, rough_pixels);
  EXPECT_GT(rough, 0);
}

TEST_F(MirrorPictures, AnyNumberOfThreadsGivesTheSamePicture) {
  const DagAttributes metal = mirror_attributes(ball_.view(), {200, 180, 90}, true, [](auto i) {
    return Numbers{static_cast<std::uint8_t>(i % 3 * 127), static_cast<std::uint8_t>(i * 41)};
  });
  options_.samples_per_pixel = 2;
  for (const std::optional<int> bounces : {std::optional<int>(), std::optional<int>(2)}) {
    options_.bounces = bounces;
    const RenderedImage one = with_threads(1, [&] { return picture(metal); });
    options_.tile_size = bounces ? 7 : 32;
    test::expect_same_picture(with_threads(3, [&] { return picture(metal); }), one);
  }
}

/// A ball sees nothing but the sky: a path that leaves it at once brings the light of the mirrored
/// place.
TEST_F(MirrorPictures, PathsMirrorTheSkyOnceTheyLeave) {
  options_.with_sun = false;
  options_.occlusion_samples = 2;
  options_.bounces = 0;
  options_.environment = std::make_shared<Environment>(128, [](Vec3f d) {
    return Vec3f{0.2f + (d.x > 0 ? 1 : 0), 0.2f + (d.y > 0 ? 1 : 0), 1};
  });
  const Value8 color{255, 128, 0};
  const RenderedImage image = picture(attributes(color, true, {255, 0}));
  const Camera camera = make_camera(image.view, image.width, image.height);
  const SkyMap map = options_.environment->map(static_cast<Vec3f>(image.view.up));
  int compared = 0, seen = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.width + x);
      const Vec3f normal = image.normal[i];
      const auto view = static_cast<Vec3f>(normalized(camera.direction(x + 0.5, y + 0.5)));
      if (normal == Vec3f{} || dot(normal, view) > -0.3f) continue;
      const Vec3f mirrored = view - normal * (2 * dot(normal, view));
      if (std::fabs(dot(mirrored, map.right)) < 0.05f || std::fabs(dot(mirrored, map.up)) < 0.05f)
        continue;
      ++seen;
      if (image.occlusion[i] < 1) continue;
      ++compared;
      const Vec3f sky = map_radiance(map, mirrored);
      const float rest = 1 + dot(normal, view), schlick = std::pow(rest, 5.0f);
      for (int c = 0; c < 3; ++c) {
        const float f0 = srgb_to_linear(static_cast<float>(color[c]) / 255);
        ASSERT_NEAR(image.radiance[i][c], sky[c] * (f0 + (1 - f0) * schlick), 2e-3f);
      }
    }
  EXPECT_GT(seen, 400);
  EXPECT_GT(compared, seen * 9 / 10);
}

/// A white floor and a white wall in the light of a lamp; `numbers` are those of the floor.
class MirrorRoom {
 public:
  explicit MirrorRoom(Numbers numbers) {
    const CellIndex index = build_cell_index(dag_.view(), kLevels);
    std::vector<Numbers> of_cells(index.view().cells, Numbers{0, 255});
    for (int x = 0; x < kWall; ++x)
      for (int z = 0; z < 1 << kLevels; ++z) {
        std::uint64_t number = 0;
        EXPECT_TRUE(find_cell_number(dag_.view(), index.view(), {x, kFloor, z}, kLevels, number));
        of_cells[number] = numbers;
      }
    attributes_ = mirror_attributes(dag_.view(), {255, 255, 255}, true,
                                    [&](std::uint64_t number) { return of_cells[number]; });
  }

  RenderedImage picture(int bounces) const {
    RenderOptions options = small_picture();
    options.look = ColoredDagView{dag_.view(), attributes_.view()};
    options.with_sun = false;
    options.sky = 0;
    options.bounces = bounces;
    options.occlusion_samples = 2;
    options.cube_pixels = options.lod_pixels = 0;
    options.lights = {point_light(kLamp)};
    options.lights[0].color = Vec3f{1, 1, 1};
    options.view.eye = {-0.4, 0.3, 0};
    options.view.target = {0.2, kFloorHeight, 0};
    options.view.up = {0, 1, 0};
    options.view.vertical_fov_degrees = 50;
    options.with_normal = true;
    return render_image(dag_.view(), test_grid(kLevels), options);
  }

  static constexpr int kLevels = 7, kFloor = 16, kWall = 112;
  static constexpr double kVoxel = 2.0 / (1 << kLevels);
  static constexpr double kFloorHeight = (kFloor + 1) * kVoxel - 1, kWallPlace = kWall * kVoxel - 1;
  static constexpr Vec3d kLamp{0.1, 0.5, 0.2};

 private:
  Svdag dag_ = dag_where(kLevels, [](int x, int y, int) {
    return (y == kFloor && x < kWall) || (x == kWall && y >= kFloor);
  });
  DagAttributes attributes_;
};

TEST(MirrorPaths, AMetalFloorShowsTheWall) {
  const MirrorRoom room({255, 0});
  const RenderedImage image = room.picture(1), highlights = room.picture(0);
  const Camera camera = make_camera(image.view, image.width, image.height);
  int compared = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto i = static_cast<std::size_t>(y * image.width + x);
      if (image.normal[i].y < 0.5f) continue;
      const Vec3d line = camera.direction(x + 0.5, y + 0.5);
      // Rays start above the cell, at 1.25 voxels.
      const Vec3d floor = image.view.eye + line * static_cast<double>(image.depth[i]) +
                          Vec3d{0, 1.25 * MirrorRoom::kVoxel, 0};
      const Vec3d mirrored = normalized(Vec3d{line.x, -line.y, line.z});
      const Vec3d wall = floor + mirrored * ((MirrorRoom::kWallPlace - floor.x) / mirrored.x);
      const Vec3d to_lamp = MirrorRoom::kLamp - wall;
      // The corner, and what is no wall.
      if (floor.x > MirrorRoom::kWallPlace - 0.1 || wall.y > 0.95 || std::fabs(wall.z) > 0.95)
        continue;
      const double distance2 = dot(to_lamp, to_lamp);
      const double expected = -to_lamp.x / (distance2 * std::sqrt(distance2)) / kPi;
      ++compared;
      const auto seen = static_cast<double>(image.radiance[i].y - highlights.radiance[i].y);
      ASSERT_NEAR(seen / expected, 1, 0.002) << x << ", " << y;
    }
  EXPECT_GT(compared, 500);
}

TEST_F(MirrorPictures, PathsLoseNoLightBetweenWhiteSurfaces) {
  const Svdag dag = mixed_scene(5, 3);
  const DagAttributes of = mirror_attributes(dag.view(), kWhite, true, [](std::uint64_t i) {
    return Numbers{static_cast<std::uint8_t>(i % 4 * 85), static_cast<std::uint8_t>(i * 37)};
  });
  light_from_everywhere();
  options_.bounces = 64;
  options_.cube_pixels = options_.lod_pixels = 0;
  options_.look = ColoredDagView{dag.view(), of.view()};
  const RenderedImage image = render_image(dag.view(), test_grid(5), options_);
  double sum = 0;
  int hits = 0;
  for (std::size_t i = 0; i < image.radiance.size(); ++i) {
    if (image.normal[i] == Vec3f{}) continue;
    // Every path carries all light, until some end in a crevice.
    ASSERT_LE(image.radiance[i].y, 1.001f);
    sum += static_cast<double>(image.radiance[i].y);
    ++hits;
  }
  ASSERT_GT(hits, 500);
  EXPECT_GT(sum / hits, 0.99);
}

}  // namespace
}  // namespace voxdag
