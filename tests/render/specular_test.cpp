// Compares highlights with a lobe in double precision, and their energy with the analytic value.
#include "voxdag/render/specular.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "voxdag/render/basis.hpp"

namespace voxdag {
namespace {

constexpr double kLobePi = std::numbers::pi;
constexpr int kExponents[] = {1, 2, 7, 20, 333, 10'000};

Vec3d random_direction(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return normalized(Vec3d{normal(rng), normal(rng), normal(rng)});
}

/// Returns the most by which a power of a cosine that was rounded to float may be off, relative.
double rounding(int exponent) { return 1e-6 + exponent * 0x1p-21; }

TEST(Specular, TheLobeIsThatOfDoublePrecision) {
  std::mt19937 rng(7);
  int bright = 0;
  for (const int exponent : kExponents)
    for (int i = 0; i < 2000; ++i) {
      const Vec3d normal = random_direction(rng), view = random_direction(rng);
      const Vec3d mirrored = normal * (2 * dot(normal, view)) - view;
      // Directions near the mirrored one, where high powers do not vanish.
      const double spread = (i % 4) / std::sqrt(exponent + 1.0);
      const Vec3d light = normalized(mirrored + random_direction(rng) * spread);
      const double cosine = std::max(0.0, dot(mirrored, light));
      const double expected = 0.4 * (exponent + 2) / (2 * kLobePi) * std::pow(cosine, exponent);
      const Vec3f reflected = mirrored_view(static_cast<Vec3f>(view), static_cast<Vec3f>(normal));
      const float lobe = phong_lobe({0.4f, exponent}, reflected, static_cast<Vec3f>(light));
      // Below the largest value times 2^-20 a lobe is black, and a cosine near 0 has no digits.
      const double slack = rounding(exponent) * expected + 1e-6 * exponent;
      EXPECT_NEAR(static_cast<double>(lobe), expected, slack) << exponent;
      bright += expected > 0.1 ? 1 : 0;
    }
  EXPECT_GT(bright, 5000);
}

/// Returns the part of the light that a surface facing up reflects in total, if the viewer is at
/// this angle from the normal: the integral of lobe times cosine over the hemisphere. By
/// Helmholtz's reciprocity the viewer's side may be integrated or the light's.
double reflected_part(const Specular& specular, double view_angle) {
  constexpr int kSteps = 300;
  const Vec3f view{static_cast<float>(std::sin(view_angle)),
                   static_cast<float>(std::cos(view_angle)), 0};
  const Vec3f mirrored = mirrored_view(view, {0, 1, 0});
  const Basis<double> basis = make_basis(static_cast<Vec3d>(mirrored));
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      // Steps of equal power of the cosine, so that there are as many in small lobes as in large.
      const double power = (i + 0.5) / kSteps, angle = 2 * kLobePi * (j + 0.5) / kSteps;
      const double cosine = std::pow(power, 1.0 / (specular.exponent + 1));
      const double sine = std::sqrt(1 - cosine * cosine);
      const Vec3d light = static_cast<Vec3d>(mirrored) * cosine +
                          (basis.u * std::cos(angle) + basis.v * std::sin(angle)) * sine;
      if (light.y <= 0) continue;
      const double density =
          (specular.exponent + 1) / (2 * kLobePi) * std::pow(cosine, specular.exponent);
      const float lobe = phong_lobe(specular, mirrored, static_cast<Vec3f>(light));
      sum += static_cast<double>(lobe) * light.y / density;
    }
  return sum / (kSteps * kSteps);
}

TEST(Specular, AViewerStraightAboveGetsThePartThatIsTheStrength) {
  for (const int exponent : kExponents)
    EXPECT_NEAR(reflected_part({0.7f, exponent}, 0), 0.7, 2e-3) << exponent;
}

TEST(Specular, NoSurfaceReflectsMoreThanItReceives) {
  for (const int exponent : kExponents) {
    double before = 1 + 2e-3;  // the rounding of the highest power
    for (double angle = 0; angle < kLobePi / 2; angle += 0.1) {
      const double part = reflected_part({1, exponent}, angle);
      EXPECT_LE(part, before) << exponent << " at " << angle;
      EXPECT_GE(part, 0) << exponent << " at " << angle;
      before = part + 1e-3;
    }
  }
}

TEST(Specular, LightBehindTheMirroredViewGivesNoHighlight) {
  EXPECT_EQ(phong_lobe({1, 3}, {0, 1, 0}, {0, -1, 0}), 0);
  EXPECT_EQ(phong_lobe({1, 2}, {0, 1, 0}, {1, 0, 0}), 0);
  EXPECT_FALSE(Specular{}.is_on());
}

}  // namespace
}  // namespace voxdag
