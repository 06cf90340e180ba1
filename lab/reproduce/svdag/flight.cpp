#include "lab/reproduce/svdag/flight.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "lab/papers/camera_paths.hpp"
#include "lab/reproduce/build_series.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/checksum.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// Returns the camera path through a scene as JSON; empty if it has none.
std::string path_through(const FoundScene& scene) {
  const std::optional<ScenePreset> preset = preset_of(scene);
  return preset && !preset->flight.empty() ? path_json(path_file(*preset)) : "";
}

/// Returns the scenes in the order of preference for the fly-through.
std::vector<FoundScene> flight_order(std::vector<FoundScene> scenes) {
  for (const char* first : {"Crysponza", "SanMiguel"})
    std::stable_partition(scenes.begin(), scenes.end(),
                          [&](const FoundScene& scene) { return scene.scene->name == first; });
  return scenes;
}

class FlightRunner {
 public:
  FlightRunner(const PapersPlan& plan, const FoundScene& scene, const std::string& path,
               CellStore& cells)
      : plan_(plan),
        scene_(scene),
        path_(plan.folder / "flight.json", path, cells),
        cells_(cells) {}

  FlightRunner(const FlightRunner&) = delete;
  FlightRunner& operator=(const FlightRunner&) = delete;
  ~FlightRunner() {
    std::error_code ignored;
    for (const char* name : {"dag.vdag", "shape.esvo", "fine.vdag"})
      fs::remove(plan_.scratch / name, ignored);
  }

  FlightRun with_esvo() {
    const int levels = plan_.flight.esvo_levels;
    const DagFile dag = built(levels, "dag.vdag", {});
    const fs::path esvo = built(levels, "shape.esvo", {"--as", "esvo", "--no-attributes"}).path;
    return traced(dag, {"--esvo", esvo}, {esvo});
  }

  /// Returns a run at the resolution of the triangles, with more options.
  FlightRun with_fine(const std::vector<std::string>& options) {
    return traced(built(plan_.flight.triangles_levels, "fine.vdag", {}), options);
  }

 private:
  /// Builds the scene's mesh, if the file is not there; returns the file.
  DagFile built(int levels, const char* name, const std::vector<std::string>& options) {
    const Cell cell = build_cell(plan_, scene_, levels, plan_.scratch / name, options);
    const CellResult result = cells_.run(cell);
    failure_ = failure_.empty() ? result.failure : failure_;
    return {cell.output, levels};
  }

  FlightRun traced(const DagFile& dag, const std::vector<std::string>& options,
                   const std::vector<fs::path>& more_inputs = {}) {
    FlightRun run = trace_path(plan_, scene_, dag, path_, plan_.flight.frames, options);
    run.cell.inputs.insert(run.cell.inputs.end(), more_inputs.begin(), more_inputs.end());
    if (failure_.empty())
      measure(run, cells_);
    else
      run.result.failure = failure_;
    return run;
  }

  const PapersPlan& plan_;
  const FoundScene& scene_;
  CameraPathFile path_;
  CellStore& cells_;
  std::string failure_;  ///< Of the first build that failed.
};

/// A run at the resolution of the triangles.
struct FineRun {
  FlightRun Flight::*run;
  std::vector<std::string> options;
};

std::vector<FineRun> fine_runs(const FlightPlan& plan) {
  return {{&Flight::with_triangles, {}},
          {&Flight::with_voxels, {"--lod", "0"}},
          {&Flight::with_cones, {"--ao-cone", "0.07"}},
          {&Flight::with_lamps, {"--light-sizes", fmt::format("{}", fmt::join(plan.lamps, ","))}}};
}

/// A scene of the fly-through and its camera path.
struct FlightScene {
  FoundScene scene;
  std::string path;
};

std::optional<FlightScene> flight_scene(const std::vector<FoundScene>& scenes) {
  for (const FoundScene& scene : flight_order(scenes)) {
    if (scene.is_absent()) continue;
    const std::string path = path_through(scene);
    if (!path.empty()) return FlightScene{scene, path};
  }
  return std::nullopt;
}

}  // namespace

CameraPathFile::CameraPathFile(fs::path path, const std::string& json, CellStore& cells)
    : path_(std::move(path)) {
  write_whole_file(path_, json);
  cells.add_input(path_, xxh3_64(std::as_bytes(std::span(json))));
}

FlightRun trace_path(const PapersPlan& plan, const FoundScene& scene, const DagFile& dag,
                     const CameraPathFile& path, int frames,
                     const std::vector<std::string>& options) {
  FlightRun run;
  run.levels = dag.levels;
  const ImageSize size = plan.flight.size;
  run.cell.inputs = {dag.path, scene.mesh, path.path()};
  run.cell.arguments = {"bench",
                        "trace",
                        dag.path,
                        "--mesh",
                        scene.mesh,
                        "--path",
                        path.path(),
                        "--frames",
                        std::to_string(frames),
                        "--size",
                        fmt::format("{}x{}", size.width, size.height),
                        "--repeat",
                        "2",
                        "--json"};
  run.cell.arguments.insert(run.cell.arguments.end(), options.begin(), options.end());
  plan.device.cast(run.cell);
  return run;
}

void measure(FlightRun& run, CellStore& cells) {
  run.result = cells.run(run.cell);
  if (!run.result.failure.empty()) return;
  for (const auto& row : run.result.json)
    if (row.at("rival") == "voxdag_cpu" && row.at("rival_agreement") != 1)
      run.result.failure =
          fmt::format("hits of {} differ from the CPU's", row.at("device_name").get<std::string>());
}

std::optional<Flight> measure_flight(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                     CellStore& cells) {
  const std::optional<FlightScene> found = flight_scene(scenes);
  if (!found) return std::nullopt;
  FlightRunner runner(plan, found->scene, found->path, cells);
  Flight flight;
  flight.scene = found->scene;
  flight.plan = plan.flight;
  flight.with_esvo = runner.with_esvo();
  for (const FineRun& fine : fine_runs(plan.flight))
    flight.*fine.run = runner.with_fine(fine.options);
  return flight;
}

std::vector<RunItem> flight_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                  CellStore& cells) {
  const std::optional<FlightScene> found = flight_scene(scenes);
  if (!found) return {};
  std::vector<RunItem> items;
  for (const FineRun& fine : fine_runs(plan.flight))
    items.push_back([&plan, &cells, found, fine] {
      FlightRunner(plan, found->scene, found->path, cells).with_fine(fine.options);
    });
  std::reverse(items.begin(), items.end());
  items.push_back(
      [&plan, &cells, found] { FlightRunner(plan, found->scene, found->path, cells).with_esvo(); });
  return items;
}

}  // namespace voxdag::lab
