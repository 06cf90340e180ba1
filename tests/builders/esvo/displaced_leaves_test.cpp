// Tests that the leaves of a displaced surface stay near the tessellated surface, and that leaves
// are large where the heights do not vary.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "support/triangle_distance.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/builders/esvo/build/check_esvo.hpp"
#include "voxdag/builders/pieces/triangle_source.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

const Grid kGrid{8, {0, 0, 0}, 1.0, kSubvoxels};

/// A slanted square wall in a grid of 256³ voxels.
struct Wall {
  Mesh mesh;
  Appearance appearance;

  Wall() {
    mesh.vertices = {{4, 4, 30}, {244, 4, 60}, {244, 244, 100}, {4, 244, 70}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    appearance.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    appearance.materials.resize(1);
  }
};

/// Returns the height texture whose texels have heights height(u, v), 0 to 1.
std::shared_ptr<const HeightTexture> heights(const std::function<double(double, double)>& height) {
  constexpr int kSize = 512;
  HeightTexture::Texels texels;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      texels.push_back(
          {static_cast<std::uint16_t>(65535 * height((x + 0.5) / kSize, (y + 0.5) / kSize))});
  return std::make_shared<const HeightTexture>(kSize, kSize, std::move(texels));
}

struct DisplacedLeaf {
  int log2_size;
  Vec3i cell;
};

class DisplacedLeaves : public testing::Test {
 protected:
  void build(const std::function<double(double, double)>& height, double amount) {
    displaced_ = std::make_unique<DisplacedTriangles>(
        wall_.mesh, wall_.appearance,
        displace_all(wall_.mesh, wall_.appearance, heights(height), amount));
    EsvoMemory memory;
    EsvoOptions options;
    const EsvoResult result =
        build_esvo(wall_.mesh, kGrid, options, nullptr, displaced_.get(), memory);
    esvo_ = {memory.take(), result.root, kGrid.levels};
    leaves_.clear();
    farthest_ = 0;
    std::vector<Clip> clips;
    visit(esvo_.root, 0, {}, clips);
    const EnclosureCheck check =
        check_enclosure(esvo_.view(), {wall_.mesh, kGrid}, kGrid, nullptr, displaced_.get(), 20000);
    EXPECT_GT(check.points, 10000u);
    EXPECT_FALSE(check.outside.has_value());
  }

  int leaves_of(int log2_size) const {
    int count = 0;
    for (const DisplacedLeaf& leaf : leaves_) count += leaf.log2_size == log2_size ? 1 : 0;
    return count;
  }

  Wall wall_;
  /// The largest distance of a sample point in a leaf of at least 8³ voxels from the surface.
  double farthest_ = 0;

 private:
  struct Clip {
    Contour contour;
    Vec3d centre;
    double half;

    bool contains(Vec3d p) const {
      const Vec3i n = contour.normal();
      const double at = dot(static_cast<Vec3d>(n), (p - centre) * (1 / half));
      return at >= contour_position<double>(length1(n), contour.low()) &&
             at <= contour_position<double>(length1(n), contour.high());
    }
  };

  void visit(std::uint64_t slot, int level, Vec3i cell, std::vector<Clip>& clips) {
    const EsvoView view = esvo_.view();
    const ChildDescriptor d = view.descriptor(slot);
    for (int child = 0; child < 8; ++child) {
      if ((d.valid_mask() >> child & 1) == 0) continue;
      const int log2_size = kGrid.levels - level - 1;
      const Vec3i at = cell * 2 + child_offset(child);
      const double half = std::ldexp(0.5, log2_size);
      const Vec3d centre = (static_cast<Vec3d>(at) * 2.0 + Vec3d{1, 1, 1}) * half;
      const bool has_contour = (d.contour_mask() >> child & 1) != 0;
      if (has_contour) clips.push_back({view.contour(slot, d, child), centre, half});
      if ((d.leaf_mask() >> child & 1) == 0) {
        visit(view.child(slot, d, child), level + 1, at, clips);
      } else {
        leaves_.push_back({log2_size, at});
        if (log2_size >= 3) sample(centre, half, clips);
      }
      if (has_contour) clips.pop_back();
    }
  }

  void sample(Vec3d centre, double half, const std::vector<Clip>& clips) {
    constexpr int kSteps = 3;
    for (int x = -kSteps; x <= kSteps; ++x)
      for (int y = -kSteps; y <= kSteps; ++y)
        sample_column(centre, Vec2d{half * x / kSteps, half * y / kSteps}, half, clips);
  }

  /// Samples the lowest and the highest point of a leaf in a column along z.
  void sample_column(Vec3d centre, Vec2d at, double half, const std::vector<Clip>& clips) {
    std::optional<Vec3d> lowest, highest;
    for (double z = -half; z <= half; z += 0.125) {
      const Vec3d p = centre + Vec3d{at.x, at.y, z};
      if (!std::all_of(clips.begin(), clips.end(), [&](const Clip& c) { return c.contains(p); }))
        continue;
      if (!lowest) lowest = p;
      highest = p;
    }
    if (highest) farthest_ = std::max({farthest_, distance(*lowest), distance(*highest)});
  }

  double distance(Vec3d p) const {
    const Vec3d reach{3, 3, 3};
    double least = 3;
    for (std::uint32_t triangle = 0; triangle < 2; ++triangle)
      displaced_->tessellate(triangle, {p - reach, p + reach}, displaced_edge_limit(kGrid),
                             [&](const MicroTriangle& micro) {
                               least = std::min(least, test::distance_to_triangle(
                                                           p, micro.positions[0],
                                                           micro.positions[1], micro.positions[2]));
                             });
    return least;
  }

  std::unique_ptr<DisplacedTriangles> displaced_;
  Esvo esvo_;
  std::vector<DisplacedLeaf> leaves_;
};

constexpr double kMaxError = 0.5 + 0.02;  // the default, and rounding

TEST_F(DisplacedLeaves, AWallOfConstantHeightHasLargeLeaves) {
  build([](double, double) { return 0.5; }, 9);
  EXPECT_GT(leaves_of(4), 100);
  EXPECT_GT(farthest_, 0.1);
  EXPECT_LE(farthest_, kMaxError);
}

TEST_F(DisplacedLeaves, AWallWithOneBumpHasLargeLeavesBesideIt) {
  build(
      [](double u, double v) {
        const double r = std::hypot(u - 0.2, v - 0.25);
        return r < 0.08 ? 0.5 + 0.5 * std::cos(r * 3.1415926 / 0.08) : 0.0;
      },
      9);
  EXPECT_GT(leaves_of(4), 100);
  EXPECT_GT(leaves_of(0), 100);
  EXPECT_LE(farthest_, kMaxError);
}

TEST_F(DisplacedLeaves, AnUnevenWallHasNoLargeLeaves) {
  build([](double u, double v) { return 0.5 + 0.5 * std::sin(97 * u) * std::cos(83 * v); }, 4);
  EXPECT_EQ(leaves_of(4) + leaves_of(3), 0);
}

TEST_F(DisplacedLeaves, AThinGrooveInAFlatWallIsNotCovered) {
  // A deep groove of three voxels, beside the corners and centres of the large cells.
  build([](double u, double) { return std::fabs(u - 0.63) < 0.006 ? 0.0 : 1.0; }, 12);
  EXPECT_GT(leaves_of(4), 100);
  EXPECT_LE(farthest_, kMaxError);
}

}  // namespace
}  // namespace voxdag
