#include "voxdag/render/surface_normal.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "support/brute_svdag.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

constexpr int kLevels = 6;
constexpr double kDegrees = 57.29577951308232;

/// Returns a layer: the voxels near the zero set of `distance`, a signed distance in voxels.
std::vector<Vec3i> surface_voxels(const std::function<double(Vec3d)>& distance) {
  std::vector<Vec3i> voxels;
  const std::int32_t n = 1 << kLevels;
  for (std::int32_t z = 0; z < n; ++z)
    for (std::int32_t y = 0; y < n; ++y)
      for (std::int32_t x = 0; x < n; ++x)
        if (std::fabs(distance(Vec3d{x + 0.5, y + 0.5, z + 0.5})) < 0.7)
          voxels.push_back({x, y, z});
  return voxels;
}

double degrees_between(Vec3f a, Vec3d b) {
  return std::acos(std::min(1.0, dot(static_cast<Vec3d>(a), normalized(b)))) * kDegrees;
}

SmoothSurface surface_at(const Svdag& dag, int level, Vec3i cell, Vec3f view, Vec3f face) {
  FreshLayers layers;
  return smooth_surface(SvdagNodes(dag.view()), level, cell, view, face, layers);
}

TEST(SurfaceNormal, IsWithinAFewDegreesOnPlanes) {
  for (const Vec3d normal :
       {Vec3d{0, 0, 1}, Vec3d{0.3, -0.2, 1}, Vec3d{1, 1, 1}, Vec3d{-1, 0.05, 0.4}}) {
    const Vec3d unit = normalized(normal);
    const auto voxels = surface_voxels([&](Vec3d p) { return dot(p - Vec3d{32, 32, 32}, unit); });
    const Svdag dag = brute_svdag(kLevels, voxels);
    // Seen along the normal and from 60 degrees off it.
    const Vec3d aside = normalized(cross(unit, Vec3d{0.3, 0.5, -0.8}));
    for (const Vec3d view : {unit, unit * 0.5 + aside * 0.866})
      for (const Vec3i v : voxels) {
        const Vec3i m = v - Vec3i{32, 32, 32};
        if (dot(m, m) > 200) continue;
        const Vec3f estimate = surface_at(dag, kLevels, v, static_cast<Vec3f>(normalized(view)),
                                          static_cast<Vec3f>(normalized(view)))
                                   .normal;
        ASSERT_LT(degrees_between(estimate, unit), 4) << normal.x << ' ' << normal.y;
      }
  }
}

TEST(SurfaceNormal, FollowsTheRadiusOfASphere) {
  const Vec3d centre{32.2, 31.7, 32.4};
  const auto voxels =
      surface_voxels([&](Vec3d p) { return std::sqrt(dot(p - centre, p - centre)) - 25; });
  const Svdag dag = brute_svdag(kLevels, voxels);
  double sum = 0;
  for (const Vec3i v : voxels) {
    const Vec3d radial = normalized(static_cast<Vec3d>(v) + Vec3d{0.5, 0.5, 0.5} - centre);
    const SmoothSurface surface =
        surface_at(dag, kLevels, v, static_cast<Vec3f>(radial), static_cast<Vec3f>(radial));
    const double error = degrees_between(surface.normal, radial);
    // On a sphere of radius 25, the surface within 4.5 cells of a cell turns by up to 10 degrees to
    // each side.
    ASSERT_LT(error, 10);
    sum += error;
    // The sphere bends away below the layer's mean.
    const Vec3d from_centre = static_cast<Vec3d>(v) + Vec3d{0.5, 0.5, 0.5} - centre;
    ASSERT_NEAR(std::sqrt(dot(from_centre, from_centre)) + static_cast<double>(surface.height), 25,
                0.6);
    ASSERT_GT(surface.is_flat, 0.9f);
  }
  EXPECT_LT(sum / static_cast<double>(voxels.size()), 2.5);
}

TEST(SurfaceNormal, FacesTheViewerFromBothSides) {
  const auto voxels = surface_voxels([](Vec3d p) { return p.y - 32.5; });
  const Svdag dag = brute_svdag(kLevels, voxels);
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f n =
        surface_at(dag, kLevels, {20, 32, 20}, normalized(Vec3f{0.8f, side, 0}), {0, side, 0})
            .normal;
    EXPECT_NEAR(n.y, side, 1e-4f);
  }
}

TEST(SurfaceNormal, IsTheViewDirectionAtALoneVoxel) {
  const Svdag dag = brute_svdag(kLevels, {{5, 6, 7}});
  const Vec3f view = normalized(Vec3f{1, 2, -3});
  const Vec3f n = surface_at(dag, kLevels, {5, 6, 7}, view, view).normal;
  EXPECT_GT(dot(n, view), 0.9999f);
}

TEST(SurfaceNormal, ReadsCoarserLevels) {
  const Vec3d unit = normalized(Vec3d{1, 2, 2});
  const auto voxels = surface_voxels([&](Vec3d p) { return dot(p - Vec3d{32, 32, 32}, unit); });
  const Svdag dag = brute_svdag(kLevels, voxels);
  const Vec3f n =
      surface_at(dag, 5, {16, 16, 16}, static_cast<Vec3f>(unit), static_cast<Vec3f>(unit)).normal;
  EXPECT_LT(degrees_between(n, unit), 6);
}

}  // namespace
}  // namespace voxdag
