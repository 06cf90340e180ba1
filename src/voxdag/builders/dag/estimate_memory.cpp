#include "voxdag/builders/dag/estimate_memory.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

/// Builds at 2^levels and returns the bytes of the stages. Throws OverMemory and Cancelled.
StageBytes measure(const BuildInput& input, int levels) {
  const double scale = std::ldexp(1.0, input.grid.levels - levels);
  BuildInput coarse = input;
  coarse.grid.levels = levels;
  coarse.grid.voxel_size *= scale;
  coarse.grid.quantization_scale /= scale;
  coarse.bin_level = std::min(input.bin_level, levels - 2);
  BuildReport report;
  StageBytes bytes;
  if (input.method == BuildMethod::kHashConsed)
    voxelize_hash_consed(coarse, report, bytes);
  else
    voxelize_by_sorting(coarse, report, bytes);
  return bytes;
}

}  // namespace

std::optional<std::uint64_t> estimate_memory(const BuildInput& input, int steps) {
  const int levels = input.grid.levels;
  const int fine = std::max(kMinLevels, levels - steps), coarse = std::max(kMinLevels, fine - 1);
  const std::uint64_t left = input.work.memory->left();
  MemoryBudget budget(left == ~std::uint64_t{0} ? 0 : left);
  BuildInput probe{
      input.mesh, input.grid, input.method, input.bin_level, {&budget, input.work.progress}};
  try {
    const StageBytes a = measure(probe, coarse), b = measure(probe, fine);
    const auto extrapolate = [&](double at_coarse, double at_fine) {
      // A surface has four times as many cells at the next level, and a DAG never grows faster.
      const double growth = fine == coarse ? 4 : std::clamp(at_fine / at_coarse, 1.0, 4.0);
      return at_coarse > 0 ? at_fine * std::pow(growth, levels - fine) : at_fine;
    };
    const double most = std::max({b.prepare, b.voxelize_fixed + extrapolate(a.voxelize, b.voxelize),
                                  extrapolate(a.merge, b.merge), extrapolate(a.number, b.number)});
    return static_cast<std::uint64_t>(most);
  } catch (const OverMemory&) {
    return std::nullopt;
  }
}

std::uint64_t area_bound(const Mesh& mesh, const Grid& grid) {
  // A leaf block, its share of inner nodes and of their tables.
  constexpr double kBlockBytes = 40;
  constexpr double kBlockSide = 4;
  double blocks = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto a = static_cast<Vec3d>(mesh.vertices[t[0]]);
    const Vec3d ab = static_cast<Vec3d>(mesh.vertices[t[1]]) - a,
                ac = static_cast<Vec3d>(mesh.vertices[t[2]]) - a;
    const Vec3d normal = cross(ab, ac);
    const double side = grid.voxel_size * kBlockSide;
    blocks += std::sqrt(dot(normal, normal)) / (side * side) +
              (std::sqrt(dot(ab, ab)) + std::sqrt(dot(ac, ac))) / side + 1;
  }
  return static_cast<std::uint64_t>(std::min(blocks * kBlockBytes, 1e18));
}

}  // namespace voxdag
