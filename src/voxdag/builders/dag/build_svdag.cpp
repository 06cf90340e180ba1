#include "voxdag/builders/dag/build_svdag.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/builders/dag/stop_watch.hpp"

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

/// Estimates the peak bytes of a build, without the mesh, from the growth of the DAG between two
/// coarse builds. The finer of the two has 2^-steps of the resolution. Takes about 4^-steps of the
/// build's time. Returns nothing if even the coarse builds exceed the budget. Throws Cancelled.
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

/// Returns a rough upper bound on the bytes of the DAG, from the area of the triangles alone. Real
/// DAGs seldom exceed it; most are much smaller.
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

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (std::uint64_t{1} << 20) - 1) >> 20) + " MiB";
}

[[noreturn]] void refuse(const MemoryBudget& budget, const std::string& needed) {
  throw OverMemory("the memory limit of " + mebibytes(budget.limit()) +
                   " is too small: the build needs " + needed);
}

/// Throws OverMemory if the limit is clearly too small, before any long work.
void check_memory(const BuildInput& input) {
  // The finer estimate is this many levels coarser than the build, and takes about a hundredth of
  // its time.
  constexpr int kSteps = 4;
  const MemoryBudget& budget = *input.work.memory;
  if (budget.limit() == 0 || area_bound(input.mesh, input.grid) < budget.left() / 2) return;
  const auto needed = estimate_memory(input, kSteps);
  if (!needed || *needed / 2 > budget.left()) throw OverMemory("");
}

Svdag build(const BuildInput& input, BuildReport& report) {
  StageBytes bytes;
  return input.method == BuildMethod::kHashConsed
             ? number_nodes(voxelize_hash_consed(input, report, bytes), input.grid.levels,
                            input.work, report)
             : merge_and_number(voxelize_by_sorting(input, report, bytes), input, report);
}

}  // namespace

BuildResult build_svdag(const Mesh& mesh, const Grid& grid, BuildMethod method, Work work) {
  MemoryBudget unlimited;
  const bool is_limited = work.memory != nullptr;
  if (!is_limited) work.memory = &unlimited;
  const MemoryBudget& budget = *work.memory;
  const int bin_level = method == BuildMethod::kHashConsed
                            ? hash_bin_level(grid.levels, mesh.triangles.size())
                            : sort_bin_level(grid.levels);
  const BuildInput input{mesh, grid, method, bin_level, work};
  const std::uint64_t held = budget.base() + budget.used();
  BuildResult result;
  try {
    check_memory(input);
    result.dag = build(input, result.report);
    MemoryReservation dag_bytes(work.memory, result.dag.view().bytes());
    if (is_limited) result.memory = std::move(dag_bytes);
  } catch (const OverMemory&) {
    result = {};
    if (const auto needed = estimate_memory(input, 2))
      refuse(budget, "about " + mebibytes(held + *needed));
    refuse(budget, "more than " + mebibytes(std::max(budget.limit(), held)));
  }
  result.report.peak_bytes = budget.peak();
  return result;
}

}  // namespace voxdag
