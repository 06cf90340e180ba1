// Compares the sampled mirror of microfacets with integrals of the lobe, and checks that no light
// is made or lost.
#include "voxdag/render/microfacet.hpp"

#include <gtest/gtest.h>

#include <random>

namespace voxdag {
namespace {

constexpr float kCosines[] = {1, 0.7f, 0.3f, 0.1f};

FacetView view_at(float cosine, float roughness) {
  return facet_view({0, 1, 0}, {std::sqrt(1 - cosine * cosine), cosine, 0}, roughness * roughness);
}

/// Calls use(x, y) for points of the unit disc with uniform density.
template <class Use>
void for_each_disc_point(int steps, const Use& use) {
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double r = std::sqrt((i + 0.5) / steps);
      const double angle = 2 * std::numbers::pi * (j + 0.5) / steps;
      use(static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)));
    }
}

MirroredParts parts_of(const FacetView& view) {
  constexpr int kSteps = 100;
  MirroredParts parts;
  for_each_disc_point(kSteps, [&](float x, float y) { parts.add(mirrored_ray(view, x, y)); });
  parts.all /= kSteps * kSteps;
  parts.fresnel /= kSteps * kSteps;
  return parts;
}

/// Two independent ways to the same integrals: facets that the viewer sees, and the lobe over all
/// directions to lights.
TEST(Microfacet, SampledFacetsMirrorWhatTheLobeDoes) {
  constexpr int kSteps = 300;
  for (const float roughness : {0.4f, 0.6f, 0.8f, 1.0f})
    for (const float cosine : kCosines) {
      const FacetView view = view_at(cosine, roughness);
      const MirroredParts parts = parts_of(view);
      double all = 0, with_fresnel = 0;
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const double up = (i + 0.5) / kSteps, side = std::sqrt(1 - up * up);
          const double angle = 2 * std::numbers::pi * (j + 0.5) / kSteps;
          float fresnel = 0;
          const double lobe = static_cast<double>(ggx_lobe(
              view, static_cast<Vec3f>(Vec3d{side * std::cos(angle), up, side * std::sin(angle)}),
              fresnel));
          all += lobe * up;
          with_fresnel += lobe * up * static_cast<double>(fresnel);
        }
      const double share = 2 * std::numbers::pi / (kSteps * kSteps);
      EXPECT_NEAR(static_cast<double>(parts.all), all * share, 4e-3) << roughness << " " << cosine;
      EXPECT_NEAR(static_cast<double>(parts.fresnel), with_fresnel * share, 4e-3);
    }
}

TEST(Microfacet, AWhiteSurfaceReflectsAllLightWhateverItsNumbers) {
  const Vec3f white{1, 1, 1};
  for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f})
    for (const float metallic : {0.0f, 0.3f, 1.0f})
      for (const float cosine : kCosines) {
        const MetallicRoughness numbers{metallic, roughness};
        const FacetView view = view_at(cosine, roughness);
        const MirroredParts parts = parts_of(view);
        // Light of radiance 1 from everywhere.
        Vec3f mirrored;
        constexpr int kSteps = 100;
        for_each_disc_point(kSteps, [&](float x, float y) {
          const MirroredRay ray = mirrored_ray(view, x, y);
          mirrored = mirrored + mirror_color(numbers, white, parts, ray.fresnel) *
                                    (ray.weight / (kSteps * kSteps));
        });
        const Vec3f sum = mirrored + diffuse_albedo(numbers, white, parts);
        EXPECT_NEAR(sum.x, 1, 2e-3f) << roughness << " " << metallic << " " << cosine;
        EXPECT_EQ(sum.x, sum.z);
      }
}

TEST(Microfacet, ColouredSurfacesReflectNoMoreThanTheLight) {
  std::mt19937 rng(2);
  const auto unit = [&] { return static_cast<float>(rng() >> 8) / 16777216.0f; };
  for (int i = 0; i < 2000; ++i) {
    const MetallicRoughness numbers{unit(), unit()};
    const Vec3f color{unit(), unit(), unit()};
    MirroredParts parts;
    const FacetView view = view_at(0.05f + 0.95f * unit(), numbers.roughness);
    const float angle = 6.28f * unit(), radius = std::sqrt(unit());
    const MirroredRay ray = mirrored_ray(view, radius * std::cos(angle), radius * std::sin(angle));
    parts.add(ray);
    const Vec3f sum = mirror_color(numbers, color, parts, ray.fresnel) * ray.weight +
                      diffuse_albedo(numbers, color, parts);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(sum[c], 0);
      EXPECT_LE(sum[c], 1.0001f);
    }
  }
}

TEST(Microfacet, AMirrorReflectsTheMirroredLineOfSight) {
  const FacetView view = view_at(0.6f, 0);
  for_each_disc_point(4, [&](float x, float y) {
    const MirroredRay ray = mirrored_ray(view, x, y);
    EXPECT_EQ(ray.weight, 1);
    const Vec3f out =
        view.x * ray.direction.x + view.y * ray.direction.y + view.z * ray.direction.z;
    EXPECT_NEAR(out.x, -0.8f, 1e-6f);
    EXPECT_NEAR(out.y, 0.6f, 1e-6f);
    EXPECT_NEAR(out.z, 0, 1e-6f);
  });
}

}  // namespace
}  // namespace voxdag
