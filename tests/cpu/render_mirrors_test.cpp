// Pictures of surfaces with the channels metallic and roughness.
#include <gtest/gtest.h>

#include "cpu/effect_scenes.hpp"
#include "support/mirror_attributes.hpp"
#include "support/picture_checks.hpp"
#include "support/with_threads.hpp"

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
  const RenderedImage one = with_threads(1, [&] { return picture(metal); });
  test::expect_same_picture(with_threads(3, [&] { return picture(metal); }), one);
}

}  // namespace
}  // namespace voxdag
