#pragma once
/// `voxdag bench trace`: how fast rays are cast, and how fast others cast the same rays.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/trace/trace_rays.hpp"
#include "voxdag/cuda/device_choice.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// A DAG or ESVO to measure.
struct TraceScene {
  std::string name;
  Grid grid;
  VoxelSet voxels;
  const Mesh* mesh = nullptr;  ///< What it was built from, for rivals that cast at triangles.
  std::filesystem::path file;  ///< The same as a .vdag, for rivals that are programs; or empty.
};

struct TracePlan {
  std::vector<std::string> layouts;  ///< As trace_layouts() names them; empty: the default.
  RayOptions rays;
  DeviceChoice device;  ///< On CUDA our casts on the CPU are a rival: they must agree.
  int views = 4;
  int repeat = 3;               ///< The fastest of so many casts of a set counts.
  std::string openvdb_program;  ///< rival_openvdb_trace, or empty.
};

struct RivalRate {
  std::string name;
  double mrays_per_second = 0;
  double agreement = 0;  ///< The part of the rays for which both or neither met something.
};

/// One class of rays in one scene, all views together.
struct TraceRow {
  std::string scene, layout;
  int levels = 0;
  RayClass rays = RayClass::kPrimary;
  std::uint64_t count = 0;  ///< Rays, of all views together.
  double mrays_per_second = 0;
  double hit_part = 0;                          ///< Of the rays.
  double cells_per_ray = 0, bytes_per_ray = 0;  ///< Cells looked at, bytes read from nodes.
  std::uint64_t layout_bytes = 0;
  std::vector<double> view_mrays_per_second;
  std::vector<RivalRate> rivals;
  bool on_cuda = false;  ///< Not every layout has kernels.
};

struct TraceResults {
  int threads = 0;
  RayOptions rays;                    ///< As they were made.
  std::string cuda_device;            ///< Of the rows on it; empty: all are the CPU's.
  std::vector<TraceRow> rows;         ///< By scene, resolution, layout, class.
  std::vector<std::string> failures;  ///< Scenes that could not be measured, and why.
};

/// Measures one scene and appends its rows. Every set of rays is made before and lies in memory;
/// ours and the rivals' casts of a set alternate, on the same threads.
void bench_trace(const TraceScene& scene, const TracePlan& plan, Progress& progress,
                 TraceResults& results);

/// An array with an object for each row and rival; bench/README.md lists the keys.
nlohmann::ordered_json trace_json(const TraceResults& results,
                                  const nlohmann::ordered_json& machine);
std::string trace_table(const TraceResults& results);
/// Bars of rays per second by class, a diagram for each scene and resolution.
std::string trace_svg(const TraceResults& results);

}  // namespace voxdag
