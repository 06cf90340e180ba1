#pragma once
/// `voxdag bench compact-rays`: bytes of the compact form against the time of rays at it.
///
/// The benchmark encodes the DAG with 1 to 4096 tables. It casts rays at each result as it is, and
/// the same rays at the plain form, both one at a time and in packets. The four take turns. It also
/// counts what some of the rays read.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/compact_rays/touched_memory.hpp"
#include "lab/rays/trace_rays.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

struct CompactRaysPlan {
  std::vector<int> tables{1, 16, 128, 1024, 2048, 4096};
  int views = 2, repeat = 3;
  RayOptions rays;
  std::size_t most_rays = 1'000'000;  ///< The largest number of rays of a class and view.
  std::size_t most_counted = 20'000;  ///< How many rays of a class have their reads counted.
};

/// The classes of rays that are measured.
inline constexpr RayClass kCompactRayClasses[] = {RayClass::kPrimary, RayClass::kShadow,
                                                  RayClass::kAo};
inline constexpr std::size_t kCompactRayClassCount = std::size(kCompactRayClasses);

/// The times of a class of rays.
struct CompactRaysTimes {
  double plain_seconds = 0, plain_packet_seconds = 0;  ///< At the plain form.
  double seconds = 0, packet_seconds = 0;              ///< At the compact form.
  double units_per_ray = 0, packet_units_per_ray = 0;  ///< Decoded units.
};

/// The compact form with one number of tables.
struct CompactRaysPoint {
  int tables = 0;
  std::uint64_t bytes = 0;
  /// Wall-clock times on all threads. Rays at the compact form need an open InPlaceDag.
  double encode_seconds = 0, decode_seconds = 0, open_seconds = 0;
  std::uint64_t open_bytes = 0;  ///< Bytes of an open DAG beyond the compact form, without caches.
  CompactRaysTimes times[kCompactRayClassCount];
  TouchedMemory touched[kCompactRayClassCount];
};

struct CompactRaysResults {
  std::string scene;
  int levels = 0;
  std::uint64_t plain_bytes = 0, nodes = 0;
  std::uint64_t cache_bytes = 0;  ///< Bytes of one thread's cache.
  std::size_t rays[kCompactRayClassCount] = {};
  TouchedMemory plain_touched[kCompactRayClassCount];
  std::vector<CompactRaysPoint> points;
};

/// Measures the DAG. Throws Error if a ray's result differs between the forms, and Cancelled.
CompactRaysResults bench_compact_rays(const std::string& scene, const SvdagView& dag,
                                      const Grid& grid, const CompactRaysPlan& plan,
                                      Progress& progress);

nlohmann::ordered_json compact_rays_json(const CompactRaysResults& results,
                                         const nlohmann::ordered_json& machine);

}  // namespace voxdag::lab
