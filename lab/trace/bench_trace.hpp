#pragma once
/// Implements `voxdag bench trace`: measures rays per second of voxdag, and of rivals with the same
/// rays.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/rays/trace_rays.hpp"
#include "lab/trace/soft_shadows.hpp"
#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/cuda/device_choice.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag::lab {

/// A DAG or ESVO to measure.
struct TraceScene {
  std::string name;
  Grid grid;
  VoxelSet voxels;
  const Mesh* mesh = nullptr;  ///< The voxels' mesh, for rivals that cast at triangles.
  std::filesystem::path file;  ///< The voxels' .vdag, for rivals that are programs; or empty.
  /// An ESVO of the same mesh on the same grid, which casts the same rays as a rival, on the same
  /// device; or empty.
  std::optional<VoxelSet> esvo{};
};

struct TracePlan {
  std::vector<std::string> layouts;  ///< As trace_layouts() names them; empty: the default.
  RayOptions rays;
  DeviceChoice device;  ///< On CUDA, voxdag's CPU casts are a rival that must agree.
  int views = 4;
  std::vector<View> path_views;     ///< The views to measure; empty: bench_views() chooses `views`.
  int repeat = 3;                   ///< Number of casts of a set; the fastest counts.
  std::vector<double> light_sizes;  ///< Of the lamps of SoftShadowRow; empty: do not measure them.
  std::string openvdb_program;      ///< rival_openvdb_trace, or empty.
  std::string nanovdb_program;      ///< rival_nanovdb_trace, or empty.

  /// Returns the option of a rival that is a program and needs the file of a DAG, or null.
  const char* program_option() const {
    if (!openvdb_program.empty()) return "--openvdb";
    return nanovdb_program.empty() ? nullptr : "--nanovdb";
  }
};

struct RivalRate {
  std::string name;
  double mrays_per_second = 0;
  double agreement = 0;  ///< Fraction of the rays with equal results: two hits or two misses.
  std::vector<double> view_mrays_per_second;  ///< Empty if it casts all views together.
  std::uint64_t bytes = 0;  ///< Size of the structure that it casts at; 0 if it does not say.
  /// Fraction of the rays for which hits_at_same_place() with Embree; empty if not compared.
  std::optional<double> same_place;
};

/// One class of rays in one scene, all views together.
struct TraceRow {
  std::string scene, layout;
  int levels = 0;
  RayClass rays = RayClass::kPrimary;
  std::uint64_t count = 0;  ///< Number of rays of all views.
  double mrays_per_second = 0;
  double hit_part = 0;                          ///< Fraction of the rays that hit.
  double cells_per_ray = 0, bytes_per_ray = 0;  ///< Visited cells, bytes read from nodes.
  std::uint64_t layout_bytes = 0;
  std::vector<double> view_mrays_per_second;
  std::vector<RivalRate> rivals;
  bool on_cuda = false;  ///< Cast on CUDA; with `auto` not every layout may fit into its memory.
};

/// Soft shadows in one scene.
struct SoftShadows {
  std::string scene;
  int levels = 0;
  SoftShadowRow row;
};

struct TraceResults {
  int threads = 0;
  RayOptions rays;             ///< Options with which the rays were recorded.
  std::string cuda_device;     ///< Device of the rows with on_cuda; empty: all rows are on the CPU.
  std::vector<TraceRow> rows;  ///< By scene, resolution, layout, class.
  std::vector<SoftShadows> soft_shadows;
  std::vector<std::string> failures;  ///< Scenes that could not be measured, and why.
};

/// Measures one scene and appends its rows. All rays are in memory before the measurement. Casts of
/// voxdag and of the rivals alternate on the same threads.
void bench_trace(const TraceScene& scene, const TracePlan& plan, Progress& progress,
                 TraceResults& results);

/// Returns an array with an object per row and rival; lab/README.md lists the keys.
nlohmann::ordered_json trace_json(const TraceResults& results,
                                  const nlohmann::ordered_json& machine);

}  // namespace voxdag::lab
