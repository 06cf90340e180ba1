#include "voxdag/mesh_view/mesh_view_source.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "meshes.hpp"
#include "support/with_threads.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

constexpr int kWidth = 53, kHeight = 37;  // not multiples of a packet's size

Camera camera_at(Vec3d eye, Vec3d target, double degrees = 60) {
  return make_camera({eye, target, {0.1, 1, 0}, degrees}, kWidth, kHeight);
}

std::vector<ViewSample> samples_of(const MeshViewSource& source, const Camera& camera,
                                   double dx = 0.5, double dy = 0.5) {
  std::vector<ViewSample> samples(kWidth * kHeight);
  source.sample(camera, {0, 0, kWidth, kHeight, 0, dx, dy}, samples);
  return samples;
}

struct BruteHit {
  double t = HUGE_VAL;
  std::size_t triangle = 0;
  double margin = 0;  ///< The least barycentric coordinate of the hit.
};

/// Finds the nearest triangle, in double: Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", 1997. Also finds the second nearest distance, to recognise ties.
BruteHit brute_force(const Mesh& mesh, Vec3d origin, Vec3d direction, double& second) {
  BruteHit best;
  second = HUGE_VAL;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto vertex = [&](std::size_t k) {
      return static_cast<Vec3d>(mesh.vertices[mesh.triangles[i][k]]);
    };
    const Vec3d a = vertex(0), ab = vertex(1) - a, ac = vertex(2) - a;
    const Vec3d p = cross(direction, ac);
    const double det = dot(ab, p);
    if (det == 0) continue;
    const Vec3d ao = origin - a, q = cross(ao, ab);
    const double u = dot(ao, p) / det, v = dot(direction, q) / det, t = dot(ac, q) / det;
    const double margin = std::min({u, v, 1 - u - v});
    if (margin < -1e-4 || t < 0) continue;
    if (t < best.t) {
      second = best.t;
      best = {t, i, margin};
    } else {
      second = std::min(second, t);
    }
  }
  return best;
}

/// Compares all pixels of a picture with brute force. Counts the pixels that floats may decide
/// differently (edges, ties); there must be few of them.
void expect_brute_force(const Mesh& mesh, const Camera& camera, double scale) {
  const MeshViewSource source(mesh);
  const auto samples = samples_of(source, camera, 0.25, 0.75);
  int unsure = 0, hits = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const ViewSample& sample = samples[static_cast<std::size_t>(y * kWidth + x)];
      const Vec3d direction = camera.direction(x + 0.25, y + 0.75);
      double second;
      const BruteHit brute = brute_force(mesh, camera.eye, direction, second);
      if (std::fabs(brute.margin) < 1e-4 || second - brute.t < 1e-5 * scale) {
        if (brute.t < HUGE_VAL) {
          ++unsure;
          continue;
        }
      }
      ASSERT_EQ(sample.is_hit(), brute.t < HUGE_VAL) << x << " " << y;
      if (!sample.is_hit()) {
        EXPECT_EQ(sample.normal, Vec3f{});
        continue;
      }
      ++hits;
      // Rounding to float moved the vertices by up to 2^-25 of the mesh's 2 units.
      const Vec3d off = sample.point - (camera.eye + direction * brute.t);
      const double steepness = std::fabs(
          static_cast<double>(dot(sample.face, static_cast<Vec3f>(normalized(direction)))));
      EXPECT_LT(std::sqrt(dot(off, off)) * steepness, 4e-7 * scale) << x << " " << y;
      EXPECT_NEAR(static_cast<double>(sample.depth), brute.t, 1e-5 * brute.t);
      EXPECT_LT(dot(static_cast<Vec3d>(sample.face), direction), 0);
      EXPECT_LT(dot(static_cast<Vec3d>(sample.normal), direction), 0);
      EXPECT_NEAR(dot(sample.face, sample.face), 1, 1e-5);
      EXPECT_NEAR(dot(sample.normal, sample.normal), 1, 1e-5);
      // Triangles without common corners are not smoothed.
      EXPECT_GT(dot(sample.face, sample.normal), 0.999f);
    }
  EXPECT_GT(hits, kWidth * kHeight / 12);
  EXPECT_LT(unsure, kWidth * kHeight / 120);
}

class MeshViewSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!VOXDAG_HAS_EMBREE) GTEST_SKIP() << "built without Embree";
  }
};

TEST_F(MeshViewSourceTest, SeesWhatBruteForceSees) {
  expect_brute_force(random_mesh(800, 1), camera_at({0.1, 0.4, 2.5}, {}), 1);
  expect_brute_force(random_mesh(800, 2), camera_at({0.05, 0.02, -0.1}, {1, 0.2, 0.3}, 90), 1);
}

TEST_F(MeshViewSourceTest, IsAsExactFarFromTheOriginOfTheWorld) {
  // Floats there are 2^-9 apart. The vertices are coarse, but points must not be coarser than
  // elsewhere.
  const Vec3d offset{30000, -20000, 25000};
  expect_brute_force(random_mesh(800, 3, offset), camera_at(offset + Vec3d{0.1, 0.4, 2.5}, offset),
                     1);
}

TEST_F(MeshViewSourceTest, IsAsExactForADistantViewer) {
  expect_brute_force(random_mesh(800, 4), camera_at({3000, 4000, 2000}, {}, 0.014), 1);
}

TEST_F(MeshViewSourceTest, HitsDoNotDependOnTheScale) {
  const Camera near = camera_at({0.1, 0.4, 2.5}, {});
  const auto expected = samples_of(MeshViewSource(random_mesh(800, 5)), near);
  for (const int exponent : {-90, -60, 61, 120}) {
    const double scale = std::ldexp(1.0, exponent);
    Mesh mesh = random_mesh(800, 5);
    for (Vec3f& vertex : mesh.vertices) vertex = vertex * static_cast<float>(scale);
    const Camera camera = camera_at(Vec3d{0.1, 0.4, 2.5} * scale, {});
    const auto samples = samples_of(MeshViewSource(mesh), camera);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ASSERT_EQ(samples[i].is_hit(), expected[i].is_hit()) << exponent << " " << i;
      const Vec3d off = samples[i].point * (1 / scale) - expected[i].point;
      EXPECT_LT(dot(off, off), 1e-20);
    }
  }
}

TEST_F(MeshViewSourceTest, ASphereLooksRoundFromInsideAndOutside) {
  const MeshViewSource source(disordered_sphere_mesh(32));
  for (const double distance : {3.0, 0.1}) {
    const Camera camera = camera_at({0, 0.02, distance}, {}, 40);
    int hits = 0;
    for (const ViewSample& sample : samples_of(source, camera)) {
      if (!sample.is_hit()) continue;
      ++hits;
      const Vec3f outwards = normalized(static_cast<Vec3f>(sample.point));
      const Vec3f expected = distance > 1 ? outwards : -outwards;
      EXPECT_GT(dot(sample.normal, expected), distance > 1 ? 0.98f : 0.999f);
    }
    EXPECT_GT(hits, 300);
  }
}

TEST_F(MeshViewSourceTest, NoRaySlipsThroughTheEdgesOfAClosedMesh) {
  const MeshViewSource source(cube_mesh());
  for (const Vec3d target : {Vec3d{1, 1, 1}, Vec3d{-1, 1, 1}, Vec3d{1, 0, 1}, Vec3d{0, -1, 1}}) {
    // Pixels so small that many rays meet an edge to float precision.
    for (const double degrees : {90.0, 0.01, 0.00001}) {
      const Camera camera = camera_at({0.1, 0.2, 0.3}, target, degrees);
      for (const ViewSample& sample : samples_of(source, camera)) ASSERT_TRUE(sample.is_hit());
    }
  }
}

TEST_F(MeshViewSourceTest, SamplesDoNotDependOnTilesOrThreads) {
  const MeshViewSource source(random_mesh(2000, 5));
  const Camera camera = camera_at({0.1, 0.4, 2.5}, {});
  const auto whole = samples_of(source, camera);
  constexpr int kTile = 8;
  constexpr std::size_t kColumns = kWidth / kTile + 1, kRows = kHeight / kTile + 1;
  with_threads(3, [&] {
    parallel_for(kColumns * kRows, [&](std::size_t i) {
      ViewTile tile{static_cast<int>(i % kColumns) * kTile,
                    static_cast<int>(i / kColumns) * kTile,
                    0,
                    0,
                    0,
                    0.5,
                    0.5};
      tile.width = std::min(kTile, kWidth - tile.x);
      tile.height = std::min(kTile, kHeight - tile.y);
      std::vector<ViewSample> samples(static_cast<std::size_t>(tile.width * tile.height));
      source.sample(camera, tile, samples);
      for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) {
          const ViewSample& part = samples[static_cast<std::size_t>(y * tile.width + x)];
          const ViewSample& all =
              whole[static_cast<std::size_t>((tile.y + y) * kWidth + tile.x + x)];
          EXPECT_EQ(part.point, all.point);
          EXPECT_EQ(part.normal, all.normal);
        }
    });
  });
}

TEST(MeshViewSourceWithoutEmbree, NamesThePackage) {
  if (VOXDAG_HAS_EMBREE) GTEST_SKIP() << "built with Embree";
  try {
    MeshViewSource{cube_mesh()};
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("libembree-dev"), std::string::npos);
  }
}

}  // namespace
}  // namespace voxdag
