/// The command line of `voxdag bench trace`.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "bench/bench_output.hpp"
#include "bench/report/bench_machine.hpp"
#include "bench/report/scratch_folder.hpp"
#include "bench/trace/bench_trace.hpp"
#include "bench/trace/trace_casters.hpp"
#include "cli/commands.hpp"
#include "cli/memory_option.hpp"
#include "cli/number_check.hpp"
#include "cli/parse.hpp"
#include "render/render_mesh.hpp"
#include "voxdag/dag/build_svdag.hpp"
#include "voxdag/file/scene_file.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/readers/read_mesh.hpp"
#include "voxdag/scenes/scenes.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

struct BenchTraceArguments {
  TracePlan plan;
  std::string mesh_file, scenes;
  BenchOutput output;
  std::vector<std::string> resolutions{"4K", "32K"};
  std::vector<int> levels;
  ImageSize size{1024, 768};
};

/// A scene of the list: a mesh somewhere below the folder of scenes, or a procedural one.
struct ListedScene {
  const char* name;
  const char* file;  ///< Null: procedural, of that name.
};

constexpr std::array kScenes{ListedScene{"crytek_sponza", "sponza.obj"},
                             ListedScene{"sibenik", "sibenik.obj"},
                             ListedScene{"sanmiguel_core", "sanmiguel_core.ply"},
                             ListedScene{"lucy", "lucy.ply"}, ListedScene{"hairball", nullptr}};

Mesh mesh_of(const ListedScene& scene, const fs::path& folder, Progress& progress) {
  if (scene.file == nullptr) return make_scene(scene.name);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == scene.file) return read_mesh(entry.path(), &progress);
  throw Error(folder, "", std::string("there is no ") + scene.file);
}

/// Builds the scene and measures it.
void bench_listed(const ListedScene& listed, const Mesh& mesh, int levels, const TracePlan& plan,
                  Progress& progress, TraceResults& results) {
  MemoryBudget memory = command_budget(0);
  BuildOptions build;
  build.memory = &memory;
  VdagMetadata metadata;
  metadata.grid = fit_grid(mesh, levels);
  const Svdag dag = build_svdag(mesh, metadata.grid, build, &progress).dag;
  TraceScene scene{listed.name, metadata.grid, dag.view(), &mesh, {}};
  const ScratchFolder folder;
  if (!plan.openvdb_program.empty()) {
    metadata.counts = count_svdag(dag.view());
    scene.file = folder.path() / "scene.vdag";
    write_vdag(scene.file, dag.view(), metadata);
  }
  bench_trace(scene, plan, progress, results);
}

TraceResults bench_list(const BenchTraceArguments& arguments, Session& session) {
  TraceResults results;
  for (const ListedScene& listed : kScenes) {
    try {
      const Mesh mesh = mesh_of(listed, arguments.scenes, session.progress);
      for (const int levels : arguments.levels)
        bench_listed(listed, mesh, levels, arguments.plan, session.progress, results);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      results.failures.push_back(std::string(listed.name) + ": " + error.what());
    }
  }
  return results;
}

TraceResults bench_file(const BenchTraceArguments& arguments, Session& session) {
  const SceneFile file(session.subject);
  if (file.voxels().esvo() != nullptr && !arguments.plan.openvdb_program.empty())
    throw Error("--openvdb", "", "takes the voxels of a DAG, not of an ESVO");
  Mesh mesh;
  if (!arguments.mesh_file.empty()) {
    mesh = read_mesh(arguments.mesh_file, &session.progress);
    check_is_mesh_of(arguments.mesh_file, mesh, file.voxels(), file.grid());
  }
  const std::string& name = file.metadata().source.name;
  TraceScene scene{name.empty() ? fs::path(session.subject).filename().string() : name, file.grid(),
                   file.voxels(), arguments.mesh_file.empty() ? nullptr : &mesh, session.subject};
  TraceResults results;
  bench_trace(scene, arguments.plan, session.progress, results);
  return results;
}

void run(BenchTraceArguments& arguments, Session& session) {
  arguments.output.check_writable();
  const nlohmann::ordered_json machine = machine_json();
  const TraceResults results =
      session.subject.empty() ? bench_list(arguments, session) : bench_file(arguments, session);
  arguments.output.write(
      trace_json(results, machine), {[&] { return trace_svg(results); }},
      fmt::format("{}{}, {} threads, load average {:.2f} before\n\n{}",
                  results.cuda_device.empty() ? "" : results.cuda_device + "; ",
                  machine.at("processor").get<std::string>(), results.threads,
                  machine.at("load_average").get<double>(), trace_table(results)),
      session);
  if (!results.failures.empty()) throw Error(results.failures.front());
}

void finish_plan(BenchTraceArguments& arguments, const Session& session) {
  arguments.plan.rays.width = arguments.size.width;
  arguments.plan.rays.height = arguments.size.height;
  parse_all("--resolution", arguments.resolutions, parse_levels, arguments.levels);
  if (!session.subject.empty()) return;
  const char* variable = std::getenv("VOXDAG_SCENES");
  if (arguments.scenes.empty() && variable != nullptr) arguments.scenes = variable;
  if (arguments.scenes.empty())
    throw CLI::ValidationError("--scenes", "is needed without a file (or VOXDAG_SCENES)");
}

}  // namespace

void add_bench_trace_command(CLI::App& parent, Session& session) {
  const auto arguments = std::make_shared<BenchTraceArguments>();
  TracePlan& plan = arguments->plan;
  CLI::App& command = *parent.add_subcommand(
      "trace", "Rays per second of every kind, beside others' casts of the same rays");
  command.footer(
      "Example:\n  voxdag bench trace sponza.vdag --mesh sponza.obj --plot rays.svg\n"
      "Without a file: Crytek Sponza, Sibenik, San Miguel, Lucy and hairball, built in memory.");
  CLI::Option* const file =
      command.add_option("file", session.subject, "A .vdag or .esvo file")->type_name("FILE");
  command.add_option("--mesh", arguments->mesh_file, "Its mesh, for Embree")
      ->needs(file)
      ->type_name("MESH");
  command
      .add_option("--scenes", arguments->scenes,
                  "Without a file: where the meshes are (default: VOXDAG_SCENES)")
      ->excludes(file)
      ->type_name("DIR");
  command
      .add_option("-r,--resolution", arguments->resolutions,
                  "Without a file: voxels a side, several with commas (default: 4K,32K)")
      ->delimiter(',')
      ->excludes(file)
      ->type_name("N,N...");
  command
      .add_option("--layout", plan.layouts,
                  "Layouts to cast at, several with commas: of a DAG paper (the default), "
                  "paper_scalar and wide, of an ESVO contours (the default), "
                  "contours_scalar, cubes and cubes_scalar")
      ->delimiter(',')
      ->check(CLI::IsMember(trace_layouts()).description(""))
      ->type_name("LAYOUT");
  add_parsed_option(command, "--size", arguments->size, parse_image_size, "WxH",
                    "Pixels of each view (default 1024x768)");
  command.add_option("--views", plan.views, "Cameras")
      ->check(whole_number(1, 64))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--shadow-samples", plan.rays.shadow_samples, "Rays to the lamp for each pixel")
      ->check(whole_number(1, 4096))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--ao", plan.rays.occlusion_samples, "Rays of occlusion for each pixel")
      ->check(whole_number(1, 4096))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--ao-cone", plan.rays.occlusion_cone,
                  "Rays of occlusion end at cells of this solid angle, such as 0.07; 0: never")
      ->check(number_from(0, 6))
      ->type_name("SR")
      ->capture_default_str();
  command
      .add_option("--rays", plan.rays.most_rays, "Most rays of a set of shadow or occlusion rays")
      ->check(whole_number(1'000, 1'000'000'000))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--lod", plan.rays.lod_pixels, "Rays end at cells of so many pixels; 0: voxels")
      ->check(number_from(0, 1000))
      ->type_name("PIXELS")
      ->capture_default_str();
  command.add_option("--repeat", plan.repeat, "Cast so often and take the fastest")
      ->check(whole_number(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--openvdb", plan.openvdb_program,
                  "bench/rival_openvdb_trace of the build, to cast the rays with OpenVDB, too")
      ->type_name("PROGRAM");
  command.add_option("-o,--output", arguments->output.json_file, "Write the JSON to a file, too")
      ->type_name("FILE.json");
  command.add_option("--plot", arguments->output.plot_files[0], "Draw bars of rays per second")
      ->type_name("FILE.svg");
  add_device_option(command, plan.device);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.callback([arguments, &session] {
    finish_plan(*arguments, session);
    session.inputs = {arguments->mesh_file};
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag
