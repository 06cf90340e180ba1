#include "bench/reproduce/svdag/flight.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "bench/papers/camera_paths.hpp"
#include "bench/reproduce/build_series.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/io/atomic_file.hpp"
#include "voxdag/io/checksum.hpp"

namespace voxdag {
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

  Flight run() {
    Flight flight;
    flight.scene = scene_;
    flight.plan = plan_.flight;
    const FlightPlan& frames = plan_.flight;
    const DagFile dag = built(frames.esvo_levels, "dag.vdag", {});
    const fs::path esvo =
        built(frames.esvo_levels, "shape.esvo", {"--as", "esvo", "--no-attributes"}).path;
    flight.with_esvo = traced(dag, {"--esvo", esvo}, {esvo});
    const DagFile fine = built(frames.triangles_levels, "fine.vdag", {});
    flight.with_triangles = traced(fine, {});
    flight.with_voxels = traced(fine, {"--lod", "0"});
    flight.with_cones = traced(fine, {"--ao-cone", "0.07"});
    flight.with_lamps =
        traced(fine, {"--light-sizes", fmt::format("{}", fmt::join(frames.lamps, ","))});
    for (const char* name : {"dag.vdag", "shape.esvo", "fine.vdag"})
      fs::remove(plan_.folder / name);
    return flight;
  }

 private:
  /// Builds the scene's mesh, if the file is not there; returns the file.
  DagFile built(int levels, const char* name, const std::vector<std::string>& options) {
    const Cell cell = build_cell(plan_, scene_, levels, plan_.folder / name, options);
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
  for (const FoundScene& scene : flight_order(scenes)) {
    if (scene.is_absent()) continue;
    const std::string path = path_through(scene);
    if (!path.empty()) return FlightRunner(plan, scene, path, cells).run();
  }
  return std::nullopt;
}

}  // namespace voxdag
