#include "voxdag/mesh/displace/displacement_seams.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include <cmath>

#include "support/displaced_crate.hpp"
#include "voxdag/mesh/displace/displaced_triangles.hpp"

namespace voxdag {
namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A fan of `count` triangles around the edge from (0,0,0) to (0,0,1), each with its own normals.
struct Fan {
  Mesh mesh;
  Appearance appearance;

  explicit Fan(int count) {
    mesh.vertices = {{0, 0, 0}, {0, 0, 1}};
    appearance.materials.resize(1);
    for (int i = 0; i < count; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(count);
      mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0.5f});
      mesh.triangles.push_back({0, 1, static_cast<std::uint32_t>(i + 2)});
      for (int c = 0; c < 3; ++c) {
        appearance.normals.push_back({-std::sin(angle), std::cos(angle), 0});
        appearance.uvs.push_back({angle, static_cast<float>(c)});
      }
    }
  }
};

TEST(DisplacementSeams, FewDifferentDisplacementsAreAllMembers) {
  const Fan fan(60);
  const DisplacedMesh mesh{fan.mesh, fan.appearance,
                           displace_all(fan.mesh, fan.appearance, stones(), 0.1)};
  const DisplacementSeams seams(mesh);
  EXPECT_EQ(seams.edge_group(0).members.size(), 60u);
  EXPECT_FALSE(seams.edge_group(0).is_pinned);
}

TEST(DisplacementSeams, AnEdgeWithVeryManyDisplacementsStaysInPlace) {
  const Fan fan(4000);
  const DisplacedMesh mesh{fan.mesh, fan.appearance,
                           displace_all(fan.mesh, fan.appearance, stones(), 0.1)};
  const DisplacementSeams seams(mesh);
  for (CornerIndex corner = 0; corner < 3 * 4000; corner += 3) {
    EXPECT_TRUE(seams.edge_group(corner).is_pinned);
    EXPECT_TRUE(seams.corner_group(corner).is_pinned);
  }
}

TEST(DisplacementSeams, AFanOfManyTrianglesIsTessellatedInLinearTime) {
  const Fan fan(4000);
  const double start = cpu_seconds();
  const DisplacedTriangles triangles(fan.mesh, fan.appearance,
                                     displace_all(fan.mesh, fan.appearance, stones(), 0.1));
  const Box3d everywhere{{-9, -9, -9}, {9, 9, 9}};
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < fan.mesh.triangles.size(); ++t)
    triangles.tessellate(t, everywhere, 0.1, [&](const MicroTriangle&) { ++count; });
  EXPECT_GT(count, 4000u * 50);
  // This takes 0.2 s. It would take over 10 s if every point of the edge averaged 4000
  // displacements.
  EXPECT_LT(cpu_seconds() - start, 3.0);
}

TEST(DisplacementSeams, GroupingIsCancelled) {
  const Fan fan(10);
  const DisplacedMesh mesh{fan.mesh, fan.appearance,
                           displace_all(fan.mesh, fan.appearance, stones(), 0.1)};
  Progress progress;
  progress.cancel();
  EXPECT_THROW(DisplacementSeams(mesh, &progress), Cancelled);
}

}  // namespace
}  // namespace voxdag
