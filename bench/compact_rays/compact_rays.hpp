#pragma once
/// `voxdag bench compact-rays`: bytes of the compact form against the time of rays at it.
///
/// The benchmark encodes the DAG with 1 to 4096 tables. It casts rays at each result as it is, one
/// at a time and with a cache of decoded nodes per thread, and casts the same rays at the plain
/// form, one at a time and in packets.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/rays/trace_rays.hpp"
#include "bench/report/charts.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct CompactRaysPlan {
  std::vector<int> tables{1, 16, 128, 1024, 2048, 4096};
  int views = 2, repeat = 3;
  RayOptions rays;
  std::size_t most_rays = 1'000'000;  ///< The largest number of rays of a class and view.
};

/// The classes of rays that are measured.
inline constexpr RayClass kCompactRayClasses[] = {RayClass::kPrimary, RayClass::kShadow,
                                                  RayClass::kAo};
inline constexpr std::size_t kCompactRayClassCount = std::size(kCompactRayClasses);

/// The compact form with one number of tables.
struct CompactRaysPoint {
  int tables = 0;
  std::uint64_t bytes = 0;
  double encode_seconds = 0, decode_seconds = 0;  ///< Wall-clock, on all threads.
  double ray_seconds[kCompactRayClassCount] = {};
  double units_per_ray[kCompactRayClassCount] = {};  ///< Units and shared bricks that were decoded.
};

struct CompactRaysResults {
  std::string scene;
  int levels = 0;
  std::uint64_t plain_bytes = 0, nodes = 0, cache_bytes = 0;
  std::size_t rays[kCompactRayClassCount] = {};
  double plain_seconds[kCompactRayClassCount] = {};   ///< One ray at a time.
  double packet_seconds[kCompactRayClassCount] = {};  ///< In packets.
  std::vector<CompactRaysPoint> points;
};

/// Measures the DAG. Throws Error if a ray's result differs between the forms, and Cancelled.
CompactRaysResults bench_compact_rays(const std::string& scene, const SvdagView& dag,
                                      const Grid& grid, const CompactRaysPlan& plan,
                                      Progress& progress);

nlohmann::ordered_json compact_rays_json(const CompactRaysResults& results,
                                         const nlohmann::ordered_json& machine);
std::string compact_rays_table(const CompactRaysResults& results);
/// Returns the time of each class of rays over the bytes, both as ratios to the plain form.
Chart compact_rays_chart(const CompactRaysResults& results, const std::filesystem::path& file);

}  // namespace voxdag
