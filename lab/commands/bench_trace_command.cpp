/// The command line of `voxdag bench trace`.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "cli/device.hpp"
#include "cli/mesh_input.hpp"
#include "cli/parse.hpp"
#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/rivals/embree_rival.hpp"
#include "lab/runs/machine.hpp"
#include "lab/trace/bench_trace.hpp"
#include "lab/trace/listed_scenes.hpp"
#include "lab/trace/trace_casters.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/render/film/path_file.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

struct BenchTraceArguments {
  TracePlan plan;
  std::string mesh_file, esvo_file, path_file, scenes;
  int frames = 60;
  BenchOutput output;
  MeshAccess access;
  std::vector<int> levels{12, 15};
  ImageSize size{1024, 768};
};

/// Returns the voxels of the ESVO in a file, which `file` keeps open. Throws Error unless they are
/// on the grid of `dag`.
VoxelSet open_esvo(const std::string& path, const SceneModel& dag, std::optional<SceneModel>& file,
                   Session& session) {
  file.emplace(path, &session.progress);
  if (file->voxels().esvo() == nullptr) throw Error(path, "", "is not an ESVO");
  if (dag.voxels().esvo() != nullptr) throw Error("--esvo", "", "needs a DAG to compare with");
  if (file->grid() != dag.grid()) throw Error(path, "", "is not on the grid of the DAG");
  return file->voxels();
}

/// Sets the plan's views, at even times on the camera path, and its sun.
void follow_path(const BenchTraceArguments& arguments, const TraceScene& scene, TracePlan& plan) {
  const double aspect = static_cast<double>(arguments.size.width) / arguments.size.height;
  const PathFile file = read_path_file(arguments.path_file);
  const CameraPath path = make_camera_path(file, scene.voxels, scene.grid, aspect, {});
  plan.rays.sun = file.sun;
  for (int i = 0; i < arguments.frames; ++i)
    plan.path_views.push_back(
        path.at(path.start() + (path.end() - path.start()) * (i + 0.5) / arguments.frames));
}

TraceResults bench_file(const BenchTraceArguments& arguments, Session& session) {
  const SceneModel file(session.subject, &session.progress);
  const char* program_option = arguments.plan.program_option();
  if (file.voxels().esvo() != nullptr && program_option != nullptr)
    throw Error(program_option, "", "needs a DAG, but the file is an ESVO");
  Mesh mesh;
  if (!arguments.mesh_file.empty()) {
    mesh = read_mesh_file(arguments.mesh_file, arguments.access, session);
    check_is_mesh_of(arguments.mesh_file, mesh, file.voxels(), file.grid());
  }
  const std::string& name = file.metadata().source.name;
  TraceScene scene{name.empty() ? fs::path(session.subject).filename().string() : name, file.grid(),
                   file.voxels(), arguments.mesh_file.empty() ? nullptr : &mesh, session.subject};
  std::optional<SceneModel> esvo;
  if (!arguments.esvo_file.empty())
    scene.esvo = open_esvo(arguments.esvo_file, file, esvo, session);
  TracePlan plan = arguments.plan;
  if (!arguments.path_file.empty()) follow_path(arguments, scene, plan);
  TraceResults results;
  bench_trace(scene, plan, session.progress, results);
  return results;
}

void run(BenchTraceArguments& arguments, Session& session) {
  arguments.output.check_writable(session.progress);
  const nlohmann::ordered_json machine = machine_json();
  const TraceResults results = session.subject.empty()
                                   ? bench_listed_scenes(arguments.scenes, arguments.levels,
                                                         arguments.plan, session.progress)
                                   : bench_file(arguments, session);
  std::string failures;
  for (const std::string& failure : results.failures) failures += "\n" + failure + "\n";
  arguments.output.write_tables(
      "trace", trace_json(results, machine),
      fmt::format("{}{}, {} threads, load average {:.2f} before\n\n",
                  results.cuda_device.empty() ? "" : results.cuda_device + "; ",
                  machine.at("processor").get<std::string>(), results.threads,
                  machine.at("load_average").get<double>()),
      failures, session);
  if (!results.failures.empty()) throw Error(results.failures.front());
}

std::string parse_layout(const std::string& text) {
  const std::vector<std::string> known = trace_layouts();
  if (std::find(known.begin(), known.end(), text) == known.end())
    throw std::invalid_argument(fmt::format("must be one of {}", fmt::join(known, ", ")));
  return text;
}

void finish_plan(BenchTraceArguments& arguments, const Session& session) {
  arguments.plan.rays.width = arguments.size.width;
  arguments.plan.rays.height = arguments.size.height;
  if (!session.subject.empty()) return;
  const char* variable = std::getenv("VOXDAG_SCENES");
  if (arguments.scenes.empty() && variable != nullptr) arguments.scenes = variable;
  if (arguments.scenes.empty())
    throw UsageError("--scenes",
                     "is required without FILE, unless the variable VOXDAG_SCENES is set");
}

int parse_beam_pixels(const std::string& text) {
  if (text == std::to_string(kBeamPixels)) return kBeamPixels;
  if (text == std::to_string(kCoarseBeamPixels)) return kCoarseBeamPixels;
  throw std::invalid_argument("is neither 4 nor 8");
}

void add_ray_options(const Command& command, RayOptions& rays) {
  command.number("--shadow-samples", rays.shadow_samples, NumberRange::whole(1, 4096), "N",
                 "Soft shadow rays per pixel, to points on a lamp");
  command.number("--ao", rays.occlusion_samples, NumberRange::whole(1, 4096), "N",
                 "Ambient occlusion rays per pixel");
  command.number("--ao-cone", rays.occlusion_cone, NumberRange::from(0, 6), "SR",
                 "End ambient occlusion rays at cells of this solid angle, such as 0.07; 0: never");
  command.number("--rays", rays.most_rays, NumberRange::whole(1'000, 1'000'000'000), "N",
                 "Maximum number of shadow rays and of occlusion rays per view");
  command.number("--lod", rays.lod_pixels, NumberRange::from(0, 1000), "PIXELS",
                 "End rays at cells of this size in the picture; 0: always at voxels");
  command.parsed("--beam-pixels", rays.beam_pixels, parse_beam_pixels, "4 | 8",
                 "Side of the beams of the CPU, in pixels");
}

/// Adds the options that choose between a file and the list of scenes.
void add_scene_options(const Command& command, BenchTraceArguments& arguments, Session& session) {
  const Option file = command.text("file", session.subject, "FILE",
                                   "A .vdag or .esvo file (default: five scenes, built in memory)");
  const Option mesh =
      command.text("--mesh", arguments.mesh_file, "MESH", "The mesh of FILE, for Embree")
          .needs(file)
          .only_if([] { return EmbreeRival::is_available(); },
                   "because this voxdag was built without Embree");
  add_mesh_access_options(command, arguments.access, &mesh);
  command
      .text("--scenes", arguments.scenes, "DIR",
            "Without FILE: the folder of the meshes (default: the variable VOXDAG_SCENES)")
      .not_with(file);
  command
      .text("--esvo", arguments.esvo_file, "FILE.esvo",
            "Also cast the rays at this ESVO of the same mesh and resolution")
      .needs(file);
  const Option path = command.text("--path", arguments.path_file, "PATH.json",
                                   "Measure views along this camera path (see render --path)");
  path.needs(file);
  command
      .number("--frames", arguments.frames, NumberRange::whole(1, 10'000), "N",
              "Number of views along the path")
      .needs(path);
  command
      .list("-r,--resolution", arguments.levels, parse_levels, "N,N...",
            "Without FILE: voxels per side (default: 4K,32K)")
      .not_with(file);
}

}  // namespace

void add_bench_trace_command(const Command& bench, Session& session) {
  const auto arguments = std::make_shared<BenchTraceArguments>();
  TracePlan& plan = arguments->plan;
  const Command command = bench.add(
      "trace",
      "Measure rays per second of every kind, also with other programs that cast the same rays",
      "voxdag bench trace sponza.vdag --mesh sponza.obj --plot rays.svg\n"
      "Without a file: Crytek Sponza, Sibenik, San Miguel, Lucy and hairball, built in memory.");
  add_scene_options(command, *arguments, session);
  command.list("--layout", plan.layouts, parse_layout, "LAYOUT,LAYOUT...",
               "Layouts to cast rays at. For a DAG: paper (the default), paper_scalar, top; for an "
               "ESVO: contours (the default), contours_scalar, cubes, cubes_scalar");
  command.parsed("--size", arguments->size, parse_image_size, "WxH",
                 "Size of each view in pixels (default: 1024x768)");
  command.number("--views", plan.views, NumberRange::whole(1, 64), "N", "Number of cameras")
      .only_if([arguments] { return arguments->path_file.empty(); }, "with --path");
  add_ray_options(command, plan.rays);
  command.list(
      "--light-sizes", plan.light_sizes, parse_positive, "RADIUS,RADIUS...",
      "Also measure soft shadows of lamps of these radii, in parts of their distance, with "
      "and without beams");
  command.number("--repeat", plan.repeat, NumberRange::whole(1, 1000), "N",
                 "Number of casts; the fastest counts");
  command.text("--openvdb", plan.openvdb_program, "PROGRAM",
               "Also cast the rays with OpenVDB: the path of rival_openvdb_trace (lab/README.md)");
  command.text("--nanovdb", plan.nanovdb_program, "PROGRAM",
               "Also cast the rays with NanoVDB on the CUDA device: the path of "
               "rival_nanovdb_trace (lab/README.md)");
  add_output_options(command, arguments->output, "Plot bars of rays per second");
  add_device_option(command, plan.device);
  add_run_options(command, session);
  command.when_parsed([arguments, &session] {
    finish_plan(*arguments, session);
    session.inputs = {arguments->mesh_file, arguments->esvo_file, arguments->path_file};
    arguments->output.check_distinct(session);
    arguments->access.outputs = arguments->output.files();
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag::lab
