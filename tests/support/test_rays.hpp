#pragma once
/// Makes random and adversarial rays around a grid.
#include <cmath>
#include <limits>
#include <random>

#include "voxdag/core/grid.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// The kinds of test rays.
enum class RayKind {
  kGeneric,   ///< Random origin in or near the grid, random direction.
  kParallel,  ///< Along an axis, from any point or on planes and edges.
  kLattice,   ///< From one voxel corner, edge or face centre to another.
  kDiagonal,  ///< Components of equal size, from a lattice point: many ties.
  kZeroes,    ///< One or two components +0 or -0.
  kTiny,      ///< One or two components denormal or very small.
  kFar,       ///< From very far away, towards a point of the grid.
  kOnFace,    ///< From a point on a voxel plane, in any direction.
  kCount,
};

/// Makes rays of every kind for one grid, in world units. Depends on the seed alone.
class TestRays {
 public:
  TestRays(const Grid& grid, unsigned seed)
      : grid_(grid), n_(static_cast<double>(grid.resolution())), rng_(seed) {}

  Ray make(RayKind kind) {
    Vec3d from = point(), direction = vector();
    switch (kind) {
      case RayKind::kGeneric:
        if (below(3) == 0) direction = point() - from;
        break;
      case RayKind::kParallel:
        direction = {};
        direction[below(3)] = below(2) == 0 ? 1 : -1;
        if (below(2) == 0) from = lattice_point();
        break;
      case RayKind::kLattice:
        from = lattice_point();
        direction = lattice_point() - from;
        break;
      case RayKind::kDiagonal:
        from = lattice_point();
        for (int axis = 0; axis < 3; ++axis) direction[axis] = below(2) == 0 ? 1 : -1;
        if (below(3) == 0) direction[below(3)] = 0;
        break;
      case RayKind::kZeroes:
        direction[below(3)] = 0.0;
        direction[below(3)] = below(2) == 0 ? 0.0 : -0.0;
        if (below(2) == 0) from = lattice_point();
        break;
      case RayKind::kTiny:
        for (int i = 0; i < 2; ++i)
          direction[below(3)] *= std::exp2(-static_cast<double>(below(150)));
        if (below(2) == 0) from = lattice_point();
        break;
      case RayKind::kFar: {
        const Vec3d target = below(2) == 0 ? inside() : lattice_point();
        from = target - direction * (n_ * std::exp2(static_cast<double>(below(60))));
        direction = target - from;
        break;
      }
      case RayKind::kOnFace:
        from = inside();
        from[below(3)] = below(static_cast<int>(n_) + 1);
        break;
      case RayKind::kCount:
        break;
    }
    Ray ray;
    ray.origin = static_cast<Vec3f>(grid_.to_world(from));
    const double scale = below(4) == 0 ? std::exp2(below(160) - 80) : 1.0;
    ray.direction = static_cast<Vec3f>(direction * (grid_.voxel_size * scale));
    set_range(ray);
    return ray;
  }

 private:
  int below(int n) { return static_cast<int>(rng_() % static_cast<unsigned>(n)); }
  double unit() { return std::uniform_real_distribution<double>(0, 1)(rng_); }

  // All values below are in voxels.
  Vec3d inside() { return {unit() * n_, unit() * n_, unit() * n_}; }
  Vec3d point() {
    if (below(2) == 0) return inside();
    return (inside() - Vec3d{n_ / 3, n_ / 3, n_ / 3}) * 3.0;
  }
  Vec3d vector() { return {unit() * 2 - 1, unit() * 2 - 1, unit() * 2 - 1}; }
  Vec3d lattice_point() {
    const auto coordinate = [&] { return below(static_cast<int>(4 * n_)) * 0.5 - n_ / 2; };
    return {coordinate(), coordinate(), coordinate()};
  }
  void set_range(Ray& ray) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    ray.t_min = 0;
    ray.t_max = kInfinity;
    const double length = std::fabs(static_cast<double>(ray.direction.x)) +
                          std::fabs(static_cast<double>(ray.direction.y)) +
                          std::fabs(static_cast<double>(ray.direction.z));
    const double reach = std::min(2 * n_ * grid_.voxel_size / (length + 1e-60), 1e38);
    switch (below(6)) {
      case 0:
        ray.t_min = static_cast<float>(unit() * reach);
        break;
      case 1:
        ray.t_max = static_cast<float>(unit() * reach);
        break;
      case 2:
        ray.t_min = static_cast<float>((unit() - 0.5) * reach);
        ray.t_max = ray.t_min + static_cast<float>(unit() * reach);
        break;
      case 3:
        ray.t_min = below(2) == 0 ? -kInfinity : static_cast<float>(-unit() * reach);
        break;
      default:
        break;
    }
  }

  Grid grid_;
  double n_;
  std::mt19937 rng_;
};

}  // namespace voxdag
