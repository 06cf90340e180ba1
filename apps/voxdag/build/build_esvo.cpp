/// `voxdag build` for ESVOs.
#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "build/build_arguments.hpp"
#include "cli/input_files.hpp"
#include "cli/stopwatch.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/file/esvo_writer.hpp"
#include "voxdag/file/model/written_by.hpp"
#include "voxdag/file/report/esvo_report.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

/// Writes each block to the file when it is finished, and counts the bytes.
class FileSink : public EsvoSink {
 public:
  explicit FileSink(EsvoFileWriter& writer) : writer_(writer) {}

  void append(std::span<const std::uint64_t> slots) override {
    writer_.append(slots);
    bytes_ += esvo_bytes(slots);
  }
  const EsvoBytes& bytes() const { return bytes_; }

 private:
  EsvoFileWriter& writer_;
  EsvoBytes bytes_;
};

/// Throws Error unless `path` is a regular file or can become one: an ESVO file is not written in
/// order, and must be readable later.
void check_regular(const std::string& path) {
  std::error_code unknown;
  if (resolve_output(path).descriptor >= 0 ||
      (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown)))
    throw Error(path, "", "an ESVO needs a regular file as its output");
}

std::map<std::string, std::string> settings_of(const BuildArguments& arguments) {
  const EsvoSettings& settings = arguments.esvo.settings;
  std::map<std::string, std::string> all = build_settings(arguments);
  all["contours"] = settings.contours ? "yes" : "no";
  all["attributes"] = settings.attributes ? "yes" : "no";
  const std::string displace = displace_text(arguments.esvo.displace);
  if (!displace.empty()) all["displace"] = displace;
  if (!settings.contours) return all;
  all["max_error"] = fmt::format("{}", settings.max_error);
  all["color_error"] = fmt::format("{}", settings.color_error);
  all["normal_error_degrees"] = fmt::format("{}", arguments.esvo.normal_degrees);
  return all;
}

struct EsvoSeconds {
  double read = 0, textures = 0, build = 0;
  double total() const { return read + textures + build; }
};

void print_summary(const EsvoReport& report, const EsvoSeconds& seconds,
                   const BuildArguments& arguments, const Session& session) {
  const double rate = static_cast<double>(report.metadata.counts.voxels()) / seconds.build;
  if (session.json) {
    nlohmann::ordered_json json = esvo_json(report);
    json["seconds"] = {{"read", seconds.read},
                       {"textures", seconds.textures},
                       {"build", seconds.build},
                       {"total", seconds.total()}};
    json["voxels_per_second"] = rate;
    json["peak_memory_bytes"] = peak_resident_bytes();
    fmt::print("{}", json_text(json));
    return;
  }
  if (session.quiet) return;
  fmt::print(
      "{}: {}\n{}{}\n"
      "  time          {}: read {}, textures {}, build and write {}\n"
      "  rate          {} voxels/s\n"
      "  peak memory   {}\n",
      arguments.output, human_bytes(report.file_bytes), arguments.transform_line(),
      esvo_table(report), human_seconds(seconds.total()), human_seconds(seconds.read),
      human_seconds(seconds.textures), human_seconds(seconds.build), human_count(rate),
      human_bytes(peak_resident_bytes()));
  if (arguments.stats) fmt::print("\n{}", esvo_level_table(report));
}

}  // namespace

void build_esvo_file(const BuildArguments& arguments, Session& session) {
  check_regular(arguments.output);
  check_writable(arguments.output);
  const EsvoArguments& esvo = arguments.esvo;
  Stopwatch watch;
  EsvoSeconds seconds;
  MemoryBudget memory = command_budget(arguments.memory_limit);
  const Work work(&memory, &session.progress);
  MeshAccess access = arguments.access;
  access.memory = &memory;
  const MeshWithAppearance source = read_mesh_files(arguments.meshes, true, access, session).source;
  seconds.read = watch.lap();
  std::vector<std::string> warnings;
  const SurfaceShading shading(source.mesh, source.appearance, &warnings, work);
  const std::optional<DisplacedTriangles> displaced =
      open_displaced(esvo.displace, source.mesh, source.appearance, warnings, work);
  print_warnings(warnings, session);
  seconds.textures = watch.lap();

  EsvoOptions options;
  options.settings = esvo.settings;
  options.settings.normal_error = static_cast<float>(esvo.normal_degrees * std::numbers::pi / 180);
  const DisplacedTriangles* const moved = displaced ? &*displaced : nullptr;
  EsvoMetadata metadata;
  GridRequest grid = arguments.grid;
  if (displaced && !grid.bounds) grid.bounds = displaced_bounds(*displaced, source.mesh);
  metadata.grid = grid_of_build(arguments, source.mesh, grid);
  warn_of_rounding(session.subject, source.mesh, metadata.grid.voxel_size, session);
  warn_of_parts_outside(arguments, source.mesh, metadata.grid, session);
  esvo.bake.check_levels(metadata.grid.levels);
  metadata.source = {names_of(arguments.meshes), source.mesh.vertices.size(),
                     source.mesh.triangles.size()};
  metadata.program = written_by();
  metadata.build = settings_of(arguments);
  metadata.presentation = arguments.presentation();
  if (displaced) metadata.build["displaced"] = "yes";
  std::optional<Occluders> occluders;
  if (esvo.bake.rays > 0 && options.settings.attributes) {
    add_bake_settings(esvo.bake, metadata.grid, metadata.build);
    occluders.emplace(source.mesh, metadata.grid, esvo.bake, options, shading, moved, work);
    options.settings.light = occluders->light();
  }
  EsvoReport report;
  {
    EsvoFileWriter writer(arguments.output);
    FileSink sink(writer);
    EsvoResult result =
        build_esvo(source.mesh, metadata.grid, options, &shading, moved, sink, work);
    metadata.root = result.root;
    metadata.counts = result.counts;
    work.poll();
    // Does not read the file back: its name may already belong to another file.
    report = {metadata, sink.bytes(), writer.finish(std::move(result.directory), metadata)};
  }
  seconds.build = watch.lap();
  warn_if_empty(metadata.counts.voxels(), arguments.output, session);
  session.bar.clear();
  print_summary(report, seconds, arguments, session);
}

}  // namespace voxdag::cli
