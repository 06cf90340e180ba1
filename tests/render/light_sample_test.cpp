// Compares light without shadows with closed forms.
#include "voxdag/render/light_sample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/render/light_beam.hpp"

namespace voxdag {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSamples = 256, kPixels = 64;

Grid test_grid() {
  Grid grid;
  grid.levels = 4;
  grid.origin = {-2, -2, -2};
  grid.voxel_size = 4.0 / 16;
  return grid;
}

/// Returns the irradiance at the origin on a surface that faces up, from a light of the colour 1.
/// Expects that every sample lies within the light's bounds. Rays start `lift` above the surface.
double irradiance(LightSpec spec, double lift = 0) {
  spec.color = Vec3f{1, 1, 1};
  const SampleSets sets(kSamples, 1);
  const Grid grid = test_grid();
  const Light light = make_light(spec, grid);
  SurfacePoint point;
  point.start = make_grid_point(grid, {0, lift, 0});
  point.surface = make_grid_point(grid, {});
  point.normal = point.face = {0, 1, 0};
  const DirectionBounds bounds = directions_to(light, point.start.position);
  double sum = 0;
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    const PixelSamples samples = pixel_samples(sets.view(), pixel, 7, 1);
    for (int i = 0; i < kSamples; ++i) {
      const LightSample sample = sample_light(sets.view(), light, point, samples, i);
      sum += static_cast<double>(sample.weight);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(sample.direction[axis], bounds.lowest[axis]);
        EXPECT_LE(sample.direction[axis], bounds.highest[axis]);
      }
    }
  }
  return sum / (kSamples * kPixels) * static_cast<double>(light.color.x);
}

TEST(LightSample, APointFallsOffWithTheSquareOfItsDistance) {
  LightSpec spec;
  spec.kind = LightKind::kPoint;
  spec.position = {3, 4, 0};
  EXPECT_NEAR(irradiance(spec), 0.8 / 25, 1e-6);
  spec.position = {3, -4, 0};
  EXPECT_EQ(irradiance(spec), 0);
}

TEST(LightSample, ASphereGivesPiTimesTheSquareOfItsSine) {
  LightSpec spec;
  spec.position = {3, 4, 0};
  for (const double radius : {0.01, 0.5, 2.0}) {
    spec.radius = radius;
    const double sine = radius / 5;
    EXPECT_NEAR(irradiance(spec) / (kPi * sine * sine * 0.8), 1, 1e-4) << radius;
  }
}

TEST(LightSample, ArrivesAtTheSurfaceNotWhereRaysStart) {
  LightSpec spec;
  spec.position = {0.3, 1, 0.2};
  for (const LightKind kind : {LightKind::kPoint, LightKind::kSphere, LightKind::kDisc}) {
    spec.kind = kind;
    spec.radius = 0.3;
    const double at_surface = irradiance(spec);
    EXPECT_GT(at_surface, 0);
    EXPECT_EQ(irradiance(spec, 0.2), at_surface);
  }
}

TEST(LightSample, ADiscOverheadGivesPiTimesTheSquareOfItsSine) {
  LightSpec spec;
  spec.kind = LightKind::kDisc;
  spec.position = {0, 2, 0};
  spec.normal = {0, -3, 0};
  spec.radius = 1;
  EXPECT_NEAR(irradiance(spec) / (kPi / 5), 1, 1e-3);
  spec.normal = {0, 1, 0};  // it shines only to one side
  EXPECT_EQ(irradiance(spec), 0);
}

TEST(LightSample, ARectangleGivesLambertsPolygonFormula) {
  LightSpec spec;
  spec.kind = LightKind::kRectangle;
  spec.position = {0.3, 1, -0.4};
  spec.edge_u = {1.5, 0.5, 0};
  spec.edge_v = {0, 0.3, 1.2};
  const Vec3d corners[4] = {spec.position, spec.position + spec.edge_u,
                            spec.position + spec.edge_u + spec.edge_v, spec.position + spec.edge_v};
  double expected = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec3d a = normalized(corners[i]), b = normalized(corners[(i + 1) % 4]);
    expected += std::acos(dot(a, b)) * normalized(cross(a, b)).y / 2;
  }
  // Chooses the side that shines: the normal must point down.
  if (cross(spec.edge_u, spec.edge_v).y > 0) std::swap(spec.edge_u, spec.edge_v);
  EXPECT_NEAR(irradiance(spec) / std::fabs(expected), 1, 2e-3);
}

TEST(LightSample, ASunGivesItsIrradianceTimesTheCosine) {
  LightSpec spec;
  spec.kind = LightKind::kSun;
  spec.position = {3, 4, 0};
  EXPECT_NEAR(irradiance(spec), 0.8, 1e-6);
  spec.radius = 0.05;
  EXPECT_NEAR(irradiance(spec), 0.8, 2e-3);
}

TEST(LightSample, WithoutAColourALightIsAsBrightAsTheSun) {
  for (const LightKind kind :
       {LightKind::kPoint, LightKind::kDisc, LightKind::kRectangle, LightKind::kSphere}) {
    LightSpec spec;
    spec.kind = kind;
    spec.position = {0, 1, 0};  // a quarter of the grid's side away
    spec.radius = 0.01;
    spec.edge_u = {0.01, 0, 0};  // it shines down
    spec.edge_v = {0, 0, 0.01};
    const Light light = make_light(spec, test_grid());
    const double green = irradiance(spec) * static_cast<double>(light.color.y) *
                         (kind == LightKind::kPoint ? 16 : 1);
    EXPECT_NEAR(green, kPi * static_cast<double>(Sky{}.sun_light.y), 0.02)
        << static_cast<int>(kind);
  }
}

TEST(LightSample, RefusesImpossibleLights) {
  LightSpec spec;
  EXPECT_THROW(make_light(spec, test_grid()), Error);  // no radius
  spec.radius = 1;
  EXPECT_NO_THROW(make_light(spec, test_grid()));
  spec.color = Vec3f{1, -1, 1};
  EXPECT_THROW(make_light(spec, test_grid()), Error);
  spec.color.reset();
  spec.position.x = HUGE_VAL;
  EXPECT_THROW(make_light(spec, test_grid()), Error);
  spec.position.x = 0;
  spec.kind = LightKind::kRectangle;
  EXPECT_THROW(make_light(spec, test_grid()), Error);
  spec.kind = LightKind::kSun;
  EXPECT_THROW(make_light(spec, test_grid()), Error);
}

}  // namespace
}  // namespace voxdag
