#pragma once
/// The fly-through of the SVDAG paper (Figures 6, 7 and 8a): rays per second of every frame, for
/// the DAG, the ESVO and the triangles, with the same rays.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/report/charts.hpp"
#include "bench/report/document.hpp"
#include "bench/reproduce/found_scenes.hpp"
#include "bench/reproduce/papers_plan.hpp"

namespace voxdag {

/// A run of `voxdag bench trace` along the path.
struct FlightRun {
  int levels = 0;
  Cell cell;
  CellResult result;
};

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

/// Returns how many times as fast as a rival voxdag casts a kind of rays in a run; NaN if it was
/// not measured. The rival's name starts with `rival`: the fastest of those counts.
double speed_ratio(const FlightRun& run, const std::string& rays, const std::string& rival);

/// Returns the sections of Figures 6, 7a, 7b and 8a. `is_drawn`: whether their charts are there.
std::vector<Section> flight_sections(const Flight& flight, bool is_drawn);
std::vector<Chart> flight_charts(const Flight& flight);
nlohmann::ordered_json flight_json(const Flight& flight);

}  // namespace voxdag
