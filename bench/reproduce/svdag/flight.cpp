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
      : plan_(plan), scene_(scene), path_(plan.folder / "flight.json"), cells_(cells) {
    write_whole_file(path_, path);
    cells_.add_input(path_, xxh3_64(std::as_bytes(std::span(path))));
  }

  Flight run() {
    Flight flight;
    flight.scene = scene_;
    flight.plan = plan_.flight;
    const fs::path dag = built(plan_.flight.esvo_levels, "dag.vdag", {});
    const fs::path esvo =
        built(plan_.flight.esvo_levels, "shape.esvo", {"--as", "esvo", "--no-attributes"});
    flight.with_esvo = traced(plan_.flight.esvo_levels, dag, {"--esvo", esvo}, {esvo});
    const fs::path fine = built(plan_.flight.triangles_levels, "fine.vdag", {});
    flight.with_triangles = traced(plan_.flight.triangles_levels, fine, {}, {});
    flight.with_voxels = traced(plan_.flight.triangles_levels, fine, {"--lod", "0"}, {});
    flight.with_cones = traced(plan_.flight.triangles_levels, fine, {"--ao-cone", "0.07"}, {});
    flight.with_lamps =
        traced(plan_.flight.triangles_levels, fine,
               {"--light-sizes", fmt::format("{}", fmt::join(plan_.flight.lamps, ","))}, {});
    for (const char* name : {"dag.vdag", "shape.esvo", "fine.vdag"})
      fs::remove(plan_.folder / name);
    return flight;
  }

 private:
  /// Builds the scene's mesh, if the file is not there; returns the file.
  fs::path built(int levels, const char* name, const std::vector<std::string>& options) {
    const Cell cell = build_cell(plan_, scene_, levels, plan_.folder / name, options);
    const CellResult result = cells_.run(cell);
    failure_ = failure_.empty() ? result.failure : failure_;
    return cell.output;
  }

  FlightRun traced(int levels, const fs::path& dag, const std::vector<std::string>& options,
                   const std::vector<fs::path>& more_inputs) {
    FlightRun run;
    run.levels = levels;
    const FlightPlan& plan = plan_.flight;
    run.cell.inputs = {dag, scene_.mesh, path_};
    run.cell.inputs.insert(run.cell.inputs.end(), more_inputs.begin(), more_inputs.end());
    run.cell.arguments = {"bench",
                          "trace",
                          dag,
                          "--mesh",
                          scene_.mesh,
                          "--path",
                          path_,
                          "--frames",
                          std::to_string(plan.frames),
                          "--size",
                          fmt::format("{}x{}", plan.size.width, plan.size.height),
                          "--repeat",
                          "2",
                          "--json"};
    run.cell.arguments.insert(run.cell.arguments.end(), options.begin(), options.end());
    if (failure_.empty())
      run.result = cells_.run(run.cell);
    else
      run.result.failure = failure_;
    return run;
  }

  const PapersPlan& plan_;
  const FoundScene& scene_;
  fs::path path_;
  CellStore& cells_;
  std::string failure_;  ///< Of the first build that failed.
};

}  // namespace

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
