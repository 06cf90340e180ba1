/// `voxdag build`: from a mesh file to a .vdag or .esvo file.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "build/build_esvo.hpp"
#include "cli/commands.hpp"
#include "cli/human.hpp"
#include "cli/memory_option.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/process_usage.hpp"
#include "inspect/dag_report.hpp"
#include "voxdag/dag/build_svdag.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/io/resolved_output.hpp"
#include "voxdag/layout/svdag_counts.hpp"
#include "voxdag/readers/read_mesh.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {
namespace {

struct BuildArguments {
  std::string output;
  std::optional<int> levels;
  std::optional<double> voxel_size;
  std::optional<Box3d> bounds;
  BuildMethod method = BuildMethod::kHashConsed;
  std::uint64_t memory_limit = 0;  ///< Bytes; 0: the default.
  bool stats = false;
  bool as_esvo = false;
  EsvoArguments esvo;
};

/// Whether it is an ESVO.
bool parse_structure(const std::string& text) {
  if (text != "dag" && text != "esvo")
    throw std::invalid_argument(fmt::format("\"{}\" is neither dag nor esvo", text));
  return text == "esvo";
}

BuildMethod parse_method(const std::string& text) {
  if (text != "hash" && text != "sort")
    throw std::invalid_argument(fmt::format("\"{}\" is neither hash nor sort", text));
  return text == "sort" ? BuildMethod::kSort : BuildMethod::kHashConsed;
}

std::uint64_t bytes_of(const Mesh& mesh) {
  return mesh.vertices.capacity() * sizeof(Vec3f) + mesh.triangles.capacity() * sizeof(Triangle) +
         mesh.triangle_materials.capacity() * sizeof(std::uint32_t);
}

/// Wall-clock seconds of what a build does, one after the other.
struct StageSeconds {
  double read = 0, build = 0, write = 0;
  double total() const { return read + build + write; }
};

/// `surface` is where the mesh's surface is, if it is not where its triangles are.
Grid choose_grid(const Mesh& mesh, const std::optional<Box3d>& surface,
                 const BuildArguments& arguments) {
  if (arguments.bounds || surface) {
    const Box3d& bounds = arguments.bounds ? *arguments.bounds : *surface;
    return arguments.levels ? grid_from_bounds(bounds, *arguments.levels)
                            : grid_from_bounds(bounds, *arguments.voxel_size);
  }
  return arguments.levels ? fit_grid(mesh, *arguments.levels)
                          : grid_from_voxel_size(mesh, *arguments.voxel_size);
}

/// The settings that shape the voxels; the grid itself stands beside them.
std::map<std::string, std::string> settings_of(const BuildArguments& arguments) {
  return {{"cover", "exact"},
          {"grid_from", arguments.bounds ? "bounds" : "mesh"},
          {"scale_from", arguments.levels ? "resolution" : "voxel_size"}};
}

/// Groups of options that the other kind of file has no use for.
constexpr const char *kOfDags = "DAG", *kOfEsvos = "ESVO";

/// Throws CLI::ValidationError where an option of the group was given.
void check_none_of(const CLI::App& command, const std::string& group) {
  const auto is_wrong = [&](const CLI::Option* option) {
    return option->get_group() == group && option->count() > 0;
  };
  for (const CLI::Option* option : command.get_options(is_wrong))
    throw CLI::ValidationError(
        option->get_name(),
        fmt::format("is for {}, and the output is {}", group == kOfDags ? "a DAG" : "an ESVO",
                    group == kOfDags ? "an ESVO" : "a DAG (see --as)"));
}

/// Throws Error if the output cannot seek: an ESVO is written piece by piece, its beginning last.
void check_regular(const std::string& path) {
  std::error_code unknown;
  if (resolve_output(path).descriptor >= 0 ||
      (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown)))
    throw Error(path, "", "an ESVO can only be written to a regular file");
}

void build_as_esvo(const BuildArguments& arguments, Session& session) {
  check_regular(arguments.output);
  check_writable(arguments.output);
  EsvoBuild build;
  build.output = arguments.output;
  build.choose_grid = [&](const Mesh& mesh, const std::optional<Box3d>& surface) {
    return choose_grid(mesh, surface, arguments);
  };
  build.settings = settings_of(arguments);
  build.memory_limit =
      arguments.memory_limit != 0 ? arguments.memory_limit : default_memory_limit();
  build.stats = arguments.stats;
  build_esvo_file(arguments.esvo, build, session);
}

nlohmann::ordered_json json_of(const DagReport& dag, const BuildReport& build,
                               const StageSeconds& seconds) {
  nlohmann::ordered_json json = dag_json(dag);
  json["seconds"] = {{"read", seconds.read},
                     {"quantize", build.quantize_seconds},
                     {"voxelize", build.voxelize_seconds},
                     {"merge", build.merge_seconds},
                     {"reduce", build.reduce_seconds},
                     {"sort", build.sort_seconds},
                     {"canonical", build.canonical_seconds},
                     {"build", seconds.build},
                     {"write", seconds.write},
                     {"total", seconds.total()}};
  json["voxels_per_second"] = static_cast<double>(dag.metadata.counts.voxels) / seconds.build;
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

std::string table_of(const DagReport& dag, const StageSeconds& seconds) {
  const double rate = static_cast<double>(dag.metadata.counts.voxels) / seconds.build;
  return fmt::format(
      "{}\n"
      "  time          {}: read {}, build {}, write {}\n"
      "  rate          {} voxels/s\n"
      "  peak memory   {}\n",
      dag_table(dag), human_seconds(seconds.total()), human_seconds(seconds.read),
      human_seconds(seconds.build), human_seconds(seconds.write), human_count(rate),
      human_bytes(peak_memory_bytes()));
}

void build(const BuildArguments& arguments, Session& session) {
  check_writable(arguments.output);
  Progress& progress = session.progress;
  Stopwatch watch;
  StageSeconds seconds;

  MemoryBudget memory = command_budget(arguments.memory_limit);
  Mesh mesh = read_mesh(session.subject, &progress);
  MemoryReservation mesh_memory(&memory, bytes_of(mesh));
  seconds.read = watch.lap();

  DagReport report;
  report.metadata.grid = choose_grid(mesh, std::nullopt, arguments);
  report.metadata.source = {std::filesystem::path(session.subject).filename().string(),
                            mesh.vertices.size(), mesh.triangles.size()};
  report.metadata.program = "voxdag " VOXDAG_VERSION;
  report.metadata.build = settings_of(arguments);
  const BuildResult result =
      build_svdag(mesh, report.metadata.grid, {arguments.method, &memory}, &progress);
  mesh = {};
  mesh_memory.resize(0);
  seconds.build = watch.lap();

  progress.throw_if_cancelled();
  const SvdagView view = result.dag.view();
  report.metadata.counts = count_svdag(view);
  report.svdag_bytes = view.bytes();
  progress.throw_if_cancelled();
  write_vdag(arguments.output, view, report.metadata);
  seconds.write = watch.lap();
  std::error_code unknown;
  report.file_bytes = std::filesystem::file_size(arguments.output, unknown);
  if (unknown) report.file_bytes = 0;  // written to a pipe or a device

  warn_if_empty(report.metadata.counts.voxels, arguments.output, session);
  session.bar.clear();
  if (session.json) {
    fmt::print("{}", json_text(json_of(report, result.report, seconds)));
  } else if (!session.quiet) {
    fmt::print("{}: {}\n{}", arguments.output, human_bytes(report.file_bytes),
               table_of(report, seconds));
    if (arguments.stats) fmt::print("\n{}", level_table(report.metadata.counts));
  }
}

}  // namespace

void add_build_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<BuildArguments>();
  CLI::App& command =
      add_command(app, "build", "Make the sparse voxel DAG, or the ESVO, of a triangle mesh",
                  "voxdag build sponza.obj -r 8192 -o sponza.vdag");
  command
      .add_option("mesh", session.subject,
                  "The mesh: OBJ, PLY, STL, glTF/GLB, or what assimp reads where it is there")
      ->type_name("MESH")
      ->required();
  command.add_option("-o,--output", arguments->output, "The file to write")
      ->type_name("FILE")
      ->required();
  CLI::Option* const as =
      add_parsed_option(command, "--as", arguments->as_esvo, parse_structure, "dag|esvo",
                        "dag: the minimal DAG; esvo: an octree with contours, colours and normals "
                        "(default: esvo for FILE.esvo, else dag)");
  add_parsed_option(command, "-r,--resolution", arguments->levels, parse_levels, "N",
                    "Voxels a side: a power of two from 4 to 1048576; 8K is 8192");
  add_parsed_option(command, "--voxel-size", arguments->voxel_size, parse_positive, "SIZE",
                    "Instead of -r: the side of a voxel in the mesh's units");
  add_parsed_option(
      command, "--bounds", arguments->bounds, parse_box, "X0,Y0,Z0,X1,Y1,Z1",
      "Where the grid is: a cube from the lower corner on (default: the mesh's bounds)");
  add_parsed_option(command, "--method", arguments->method, parse_method, "hash|sort",
                    "hash: depth-first with a hash of nodes; sort: the paper's. Same result")
      ->group(kOfDags);
  add_memory_option(command, arguments->memory_limit);
  command.add_flag("--stats", arguments->stats, "Show the nodes of each level too");
  add_esvo_options(command, arguments->esvo);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.callback([arguments, as, &command, &session] {
    if (as->empty()) arguments->as_esvo = arguments->output.ends_with(".esvo");
    check_none_of(command, arguments->as_esvo ? kOfDags : kOfEsvos);
    check_distinct({{"--output", arguments->output}}, session);
    if (arguments->levels.has_value() == arguments->voxel_size.has_value())
      throw CLI::ValidationError("exactly one of -r/--resolution and --voxel-size is needed");
    session.work = [arguments, &session] {
      arguments->as_esvo ? build_as_esvo(*arguments, session) : build(*arguments, session);
    };
  });
}

}  // namespace voxdag
