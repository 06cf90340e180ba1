// Compares casts at an ESVO with references. Cubes are compared with the DAG of the same voxels,
// contours with every shape in double precision.
#include "voxdag/trace/esvo_cast.hpp"

#include <gtest/gtest.h>

#include "reference_esvo.hpp"
#include "support/brute_svdag.hpp"
#include "support/test_esvo.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/trace/cell_blocks.hpp"
#include "voxdag/trace/stop_below_size.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

Grid test_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {-3.7, 11.3, 0.1};
  grid.voxel_size = 0.0371;
  return grid;
}

/// Returns whether a walk down the layout finds the voxel.
template <class Nodes>
bool voxel_is_set(const Nodes& nodes, Vec3i voxel) {
  const int last = nodes.levels() - 1;
  typename Nodes::Node node = nodes.root();
  if (!descend(nodes, node, 0, last, {voxel.x >> 1, voxel.y >> 1, voxel.z >> 1})) return false;
  const int index = (voxel.x & 1) | (voxel.y & 1) << 1 | (voxel.z & 1) << 2;
  return (nodes.child_mask(node, last) >> index & 1u) != 0;
}

template <class Body>
void for_each_ray(const Grid& grid, int count, unsigned seed, const Body& body) {
  TestRays rays(grid, seed);
  for (int i = 0; i < count; ++i)
    for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind)
      body(rays.make(static_cast<RayKind>(kind)));
}

TEST(EsvoCast, CubesAreHitLikeTheVoxelsOfTheDag) {
  for (const int levels : {2, 3, 5}) {
    const Grid grid = test_grid(levels);
    for (const NamedVoxels& set : voxel_sets(levels, 7)) {
      if (set.voxels.empty()) continue;
      const Svdag dag = brute_svdag(levels, set.voxels);
      const Esvo esvo = TestEsvoAssembler(3, 1).assemble(*test_octree(levels, set.voxels), levels);
      const SvdagNodes dag_nodes(dag.view());
      const StopBelowSize stops[] = {{}, {0.06f, 0.1f, 2}};
      for_each_ray(grid, 150, 11, [&](const Ray& ray) {
        for (const StopBelowSize& stop : stops) {
          const Hit expected = closest_hit(dag_nodes, grid, ray, stop);
          EXPECT_EQ(closest_hit(EsvoNodes(esvo.view()), grid, ray, stop), expected) << set.name;
          EXPECT_EQ(closest_hit(ContourNodes(esvo.view()), grid, ray, stop), expected) << set.name;
          EXPECT_EQ(any_hit(ContourNodes(esvo.view()), grid, ray, stop), expected.hit);
        }
      });
    }
  }
}

TEST(EsvoCast, CoarseLeavesAreHitWhereTheirVoxelsAre) {
  constexpr int kLevels = 5;
  const Grid grid = test_grid(kLevels);
  const auto voxels = voxels_where(kLevels, [](Vec3i v) {
    return (v.x ^ v.y) < 8 || ((v.x >> 2 ^ v.z >> 2) & 3) == 3 || (v.x == v.z && v.y > 20);
  });
  const Svdag dag = brute_svdag(kLevels, voxels);
  auto tree = test_octree(kLevels, voxels);
  merge_full_voxels(*tree);
  const Esvo esvo = TestEsvoAssembler(2, 5).assemble(*tree, kLevels);
  int coarse = 0;
  for_each_ray(grid, 300, 3, [&](const Ray& ray) {
    const Hit expected = closest_hit(SvdagNodes(dag.view()), grid, ray);
    const Hit hit = closest_hit(ContourNodes(esvo.view()), grid, ray);
    ASSERT_EQ(hit.hit, expected.hit);
    if (!hit.hit) return;
    EXPECT_EQ(hit.t, expected.t);
    // The planes between the voxels of a coarse leaf are not sides of the leaf.
    EXPECT_TRUE(hit.face == expected.face || hit.level < kLevels);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(hit.voxel[axis] >> (kLevels - hit.level),
                expected.voxel[axis] >> (kLevels - hit.level));
    coarse += hit.level < kLevels ? 1 : 0;
    // A walk that does not know coarse leaves sees all voxels in them.
    EXPECT_TRUE(voxel_is_set(EsvoNodes(esvo.view()), expected.voxel));
  });
  EXPECT_GT(coarse, 100);
}

/// A random octree with contours, its ESVO, and rays at it.
struct ContourScene {
  ContourScene(int levels_in, unsigned seed) : levels(levels_in), grid(test_grid(levels)) {
    std::mt19937 rng(seed);
    root = random_octree(rng, 0, levels);
    esvo = TestEsvoAssembler(1 + seed % 5, seed).assemble(*root, levels);
  }

  int levels;
  Grid grid;
  std::unique_ptr<TestVoxel> root;
  Esvo esvo;
};

/// Lists the planes of all contours: a point on each plane and its normal, in the grid's [0,1]³.
void list_planes(const TestVoxel& voxel, int level, Vec3i cell,
                 std::vector<std::pair<Vec3d, Vec3d>>& planes) {
  const double side = std::ldexp(1.0, -level);
  if (voxel.contour) {
    const Vec3d n = static_cast<Vec3d>(voxel.contour->normal());
    const Vec3d centre = (static_cast<Vec3d>(cell) + Vec3d{0.5, 0.5, 0.5}) * side;
    for (const int position : {voxel.contour->low(), voxel.contour->high()}) {
      const double at =
          side / 2 * contour_position<double>(length1(voxel.contour->normal()), position);
      planes.push_back({centre + n * (at / dot(n, n)), n});
    }
  }
  for (int i = 0; i < 8; ++i)
    if (const TestVoxel* child = voxel.children[static_cast<std::size_t>(i)].get())
      list_planes(*child, level + 1, cell * 2 + child_offset(i), planes);
}

/// Checks hits up to rounding: a ray that meets a shape by more than a margin must hit it, and a
/// hit must lie on a shape. Returns whether there was a hit.
bool expect_sound_hit(const ContourScene& scene, const Ray& ray, int last_level) {
  // Margins larger than the rounding of single precision: for planes of cubes, and for planes of
  // contours beyond their slack.
  constexpr double kCube = 0x1p-21, kSlack = 0x1p-18;
  // The contours' own slack is proven to cover all rounding errors.
  constexpr double kContour = 1e-12;
  const GridRay grid_ray = make_grid_ray(scene.grid, ray);
  EsvoHit hit;
  const auto stop = [&](int level, float, float) { return level == last_level; };
  const bool is_hit = cast(ContourNodes(scene.esvo.view()), grid_ray, stop, hit);
  if (grid_ray.misses()) {
    EXPECT_FALSE(is_hit);
    return false;
  }
  const ReferenceRay reference(grid_ray);
  const auto expected =
      ReferenceCast(reference, {kCube, kContour}).nearest(*scene.root, last_level);
  if (expected) {
    EXPECT_TRUE(is_hit) << expected->t << " level " << expected->level;
    if (is_hit) {
      EXPECT_LE(static_cast<double>(hit.t), expected->t * (1 + 0x1p-22) + 0x1p-30);
    }
  }
  if (!is_hit) return false;
  EXPECT_GE(hit.t, grid_ray.t_min);
  EXPECT_LE(hit.t, grid_ray.t_max);
  const Hit world = to_hit(grid_ray, hit, scene.levels, ray.t_min, ray.t_max);
  const int shift = scene.levels - hit.level;
  const Vec3i cell{world.voxel.x >> shift, world.voxel.y >> shift, world.voxel.z >> shift};
  EXPECT_TRUE(
      is_in_shape(*scene.root, hit.level, cell, reference.at(static_cast<double>(hit.t)), kSlack));
  EXPECT_EQ(hit.voxel.child, (cell.x & 1) | (cell.y & 1) << 1 | (cell.z & 1) << 2);
  const ChildDescriptor parent = scene.esvo.view().descriptor(hit.voxel.slot);
  EXPECT_TRUE((parent.leaf_mask() >> hit.voxel.child & 1u) != 0 || hit.level == last_level);
  return true;
}

TEST(EsvoCast, RaysMeetShapesWhereTheyAre) {
  int hits = 0, rays = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const ContourScene scene(2 + static_cast<int>(seed % 4), seed);
    for_each_ray(scene.grid, 120, seed, [&](const Ray& ray) {
      ++rays;
      hits += expect_sound_hit(scene, ray, seed % 3 == 0 ? 2 : scene.levels) ? 1 : 0;
    });
  }
  EXPECT_GT(hits, rays / 15);
}

TEST(EsvoCast, RaysInAndAlongThePlanesOfContoursMissNothing) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> unit(0, 1);
  int hits = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const ContourScene scene(3 + static_cast<int>(seed % 2), 100 + seed);
    const double side = scene.grid.side();
    std::vector<std::pair<Vec3d, Vec3d>> planes;
    list_planes(*scene.root, 0, {}, planes);
    for (int i = 0; i < 3000; ++i) {
      const auto& [point, normal] = planes[rng() % planes.size()];
      Vec3d direction{unit(rng) - 0.5, unit(rng) - 0.5, unit(rng) - 0.5};
      direction = direction - normal * (dot(direction, normal) / dot(normal, normal));
      const double tilts[] = {0, 1e-3, -1e-3, 1e-6};
      direction = direction + normal * (tilts[rng() % 4] / std::sqrt(dot(normal, normal)));
      const Vec3d start = point - direction * (unit(rng) * 3);
      Ray ray;
      ray.origin = static_cast<Vec3f>(scene.grid.origin + start * side);
      ray.direction = static_cast<Vec3f>(direction * side);
      ray.t_max = HUGE_VALF;
      hits += expect_sound_hit(scene, ray, scene.levels) ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(EsvoCast, FarRaysAtTheFinestVoxelsMissNothing) {
  // One voxel of side 2^-16 with a thin contour, seen from across the grid.
  constexpr int kLevels = 16;
  const Grid grid = test_grid(kLevels);
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> unit(0, 1);
  int hits = 0;
  for (int scene_at = 0; scene_at < 50; ++scene_at) {
    const auto any = [&] { return static_cast<std::int32_t>(rng() % (1u << kLevels)); };
    const Vec3i voxel{any(), any(), any()};
    auto root = test_octree(kLevels, {voxel});
    const Contour random = random_contour(rng);
    first_leaf(*root).contour = Contour::make(random.normal(), 63, 64);
    ContourScene scene(2, 1);
    scene.levels = kLevels;
    scene.grid = grid;
    scene.root = std::move(root);
    scene.esvo = TestEsvoAssembler(2, 1).assemble(*scene.root, kLevels);
    for (int i = 0; i < 100; ++i) {
      const Vec3d target = static_cast<Vec3d>(voxel) + Vec3d{unit(rng), unit(rng), unit(rng)};
      const double n = static_cast<double>(grid.resolution());
      const Vec3d from{unit(rng) * n, unit(rng) * n, unit(rng) * n};
      Ray ray;
      ray.origin = static_cast<Vec3f>(grid.to_world(from));
      ray.direction = static_cast<Vec3f>((target - from) * grid.voxel_size);
      ray.t_max = HUGE_VALF;
      hits += expect_sound_hit(scene, ray, kLevels) ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(EsvoCast, TheEnteredPlaneHasTheNormalThatFacesTheRay) {
  // A slab across one voxel: x + y lies between the middle and half way up.
  auto root = test_octree(2, {{1, 1, 1}});
  root->children[0]->children[7]->contour = Contour::make({10, 10, 0}, 63, 96);
  const Esvo esvo = TestEsvoAssembler(1, 1).assemble(*root, 2);
  Grid grid;
  const auto shoot = [&](Vec3f origin, Vec3f direction, EsvoHit& hit) {
    const GridRay ray = make_grid_ray(grid, {origin, 0, direction, HUGE_VALF});
    EXPECT_TRUE(cast(ContourNodes(esvo.view()), ray, StopAtVoxels{}, hit));
    return entered_normal(ray, hit);
  };
  EsvoHit hit;
  const float diagonal = std::sqrt(0.5f);
  const Vec3f from_above = shoot({4, 4, 1.5f}, {-1, -1, 0}, hit);
  EXPECT_TRUE(hit.is_through_contour());
  EXPECT_NEAR(from_above.x, diagonal, 1e-6f);
  EXPECT_NEAR(from_above.y, diagonal, 1e-6f);
  EXPECT_EQ(from_above.z, 0);
  EXPECT_EQ(
      to_hit(make_grid_ray(grid, {{4, 4, 1.5f}, 0, {-1, -1, 0}, HUGE_VALF}), hit, 2, 0, 9).face,
      Face::kPositiveX);
  const Vec3f from_below = shoot({0, 0, 1.5f}, {1, 1, 0}, hit);
  EXPECT_NEAR(from_below.x, -diagonal, 1e-6f);
  EXPECT_NEAR(from_below.y, -diagonal, 1e-6f);
  const Vec3f from_the_side = shoot({1.4f, 1.7f, 4}, {0, 0, -1}, hit);
  EXPECT_FALSE(hit.is_through_contour());
  EXPECT_EQ(from_the_side, (Vec3f{0, 0, 1}));
}

}  // namespace
}  // namespace voxdag
