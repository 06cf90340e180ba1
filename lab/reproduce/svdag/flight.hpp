#pragma once
/// The fly-through of the SVDAG paper (Figures 6, 7 and 8a): rays per second of every frame, for
/// the DAG, the ESVO and the triangles, with the same rays.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/report/charts.hpp"
#include "lab/report/document.hpp"
#include "lab/reproduce/found_scenes.hpp"
#include "lab/reproduce/papers_plan.hpp"
#include "lab/reproduce/run_items.hpp"

namespace voxdag::lab {

/// A run of `voxdag bench trace` along the path.
struct FlightRun {
  int levels = 0;
  Cell cell;
  CellResult result;
};

/// A file with a camera path, as an input of cells.
class CameraPathFile {
 public:
  /// Writes `json` to `path` and states its content to `cells`. Throws Error.
  CameraPathFile(std::filesystem::path path, const std::string& json, CellStore& cells);
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A DAG in a file.
struct DagFile {
  std::filesystem::path path;
  int levels = 0;
};

/// Returns a run of `voxdag bench trace` along a path that has no result yet. `options`: more of
/// its options.
FlightRun trace_path(const PapersPlan& plan, const FoundScene& scene, const DagFile& dag,
                     const CameraPathFile& path, int frames,
                     const std::vector<std::string>& options);

/// Returns the rate of voxdag's rays of a kind in a run, in millions per second; NaN if it was not
/// measured.
double mrays_per_second(const FlightRun& run, const std::string& rays);

/// Sets the run's result. A hit of a CUDA device that differs from the CPU's is a failure. Throws
/// Error and Cancelled.
void measure(FlightRun& run, CellStore& cells);

/// The measurements of one scene's fly-through.
struct Flight {
  FoundScene scene;
  FlightPlan plan;
  FlightRun with_esvo;       ///< DAG, ESVO and triangles.
  FlightRun with_triangles;  ///< DAG and triangles, at a higher resolution.
  FlightRun with_voxels;     ///< The same resolution, with rays that end only at voxels.
  FlightRun with_cones;      ///< The same, with occlusion rays that end at cells of 0.07 sr.
  FlightRun with_lamps;      ///< The same, with soft shadows of lamps of several sizes.
};

/// Measures the fly-through of San Miguel or, if it is absent, of another scene that has a camera
/// path. Returns nothing if no scene has one. Throws Error and Cancelled.
std::optional<Flight> measure_flight(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                     CellStore& cells);

/// Returns the runs of measure_flight() as items, about the longest first.
std::vector<RunItem> flight_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                  CellStore& cells);

/// Returns how many times as fast as a rival voxdag casts a kind of rays in a run; NaN if it was
/// not measured. The rival's name starts with `rival`: the fastest of those counts. Embree compares
/// with voxdag on the CPU.
double speed_ratio(const FlightRun& run, const std::string& rays, const std::string& rival);

/// Returns the sections of Figures 6, 7a, 7b and 8a. `is_drawn`: whether their charts are there.
std::vector<Section> flight_sections(const Flight& flight, bool is_drawn);
std::vector<Chart> flight_charts(const Flight& flight);
nlohmann::ordered_json flight_json(const Flight& flight);
nlohmann::ordered_json run_json(const FlightRun& run);

}  // namespace voxdag::lab
