#pragma once
/// Gaussian splats, and their extinction in a grid of voxels.
///
/// Source of the splats: Kerbl, Kopanas, Leimkühler and Drettakis, "3D Gaussian Splatting for
/// Real-Time Radiance Field Rendering", 2023. docs/splats.md states the rule that sets voxels.
#include <array>
#include <cstdint>

#include "voxdag/core/box.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// A Gaussian without its centre.
struct Splat {
  std::array<float, 4> rotation{1, 0, 0, 0};  ///< Quaternion w, x, y, z; its length is ignored.
  std::array<float, 3> scale{};  ///< Standard deviations along its own axes, in world units.
  float extinction = 0;          ///< At its centre, from 0 to kMaxExtinction.
};

/// ln 100, the extinction of an opacity of 0.99: renderers of splats cap opacities there.
inline constexpr float kMaxExtinction = 4.60517019f;

/// A splat has no extinction beyond so many standard deviations.
inline constexpr double kSplatReach = 3;

/// Extinctions are summed as whole numbers of 2^-32.
inline constexpr double kExtinctionUnits = 0x1p32;

/// Returns the splat of the numbers that files store: `opacity` is ln(a / (1 - a)) for the opacity
/// a. Numbers that are not finite give splats that are not usable.
Splat splat_of_logarithms(const std::array<float, 4>& rotation,
                          const std::array<float, 3>& log_scale, float opacity);

/// Returns the extinction of an opacity from 0 to 1.
float extinction_of(double opacity);

/// Returns whether all numbers are finite and the rotation is not 0.
bool is_usable(const Splat& splat);

/// A splat in the coordinates of a grid, in which the centres of voxels are whole numbers.
struct GridSplat {
  Vec3d center;
  /// The distance in standard deviations is the length of (u0, u1, u2); uk = rows[k] · (p -
  /// center).
  std::array<Vec3d, 3> rows;
  double extinction = 0;                 ///< In units of 1 / kExtinctionUnits.
  Box3i box;                             ///< Of the voxels of the grid that it may reach.
  std::array<std::uint16_t, 3> color{};  ///< In linear light.
};

/// Places a usable splat, whose centre is finite, in a grid of `side` voxels a side. Standard
/// deviations below `min_scale`, in world units, become min_scale.
GridSplat grid_splat(const Splat& splat, Vec3d center, double voxel_size, double min_scale,
                     std::int32_t side);

/// Returns how far the splat reaches along the world's axes.
Vec3d reach_of(const Splat& splat);

/// Returns true only if the splat reaches no voxel of the box.
bool misses(const GridSplat& splat, const Box3i& voxels);

}  // namespace voxdag
