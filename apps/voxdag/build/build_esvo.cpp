#include "build/build_esvo.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <numbers>

#include "cli/human.hpp"
#include "cli/memory_option.hpp"
#include "cli/number_check.hpp"
#include "cli/process_usage.hpp"
#include "inspect/esvo_report.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/esvo_writer.hpp"
#include "voxdag/readers/read_appearance.hpp"

namespace voxdag {
namespace {

/// Writes blocks to the file as they come, and counts their bytes.
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

/// Bytes of a mesh and its appearance in memory.
std::uint64_t bytes_of(const MeshWithAppearance& source) {
  const auto bytes = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  const Appearance& appearance = source.appearance;
  std::uint64_t sum = bytes(source.mesh.vertices) + bytes(source.mesh.triangles) +
                      bytes(source.mesh.triangle_materials) + bytes(appearance.normals) +
                      bytes(appearance.uvs) + bytes(appearance.colors);
  for (const TextureImage& image : appearance.images) sum += image.bytes.capacity();
  return sum;
}

std::map<std::string, std::string> settings_of(const EsvoArguments& arguments,
                                               const EsvoBuild& build) {
  const EsvoSettings& settings = arguments.options.settings;
  std::map<std::string, std::string> all = build.settings;
  all["contours"] = settings.contours ? "yes" : "no";
  all["attributes"] = settings.attributes ? "yes" : "no";
  const std::string displace = displace_text(arguments.displace);
  if (!displace.empty()) all["displace"] = displace;
  if (!settings.contours) return all;
  all["max_error"] = fmt::format("{}", settings.max_error);
  all["color_error"] = fmt::format("{}", settings.color_error);
  all["normal_error_degrees"] = fmt::format("{}", arguments.normal_degrees);
  return all;
}

struct EsvoSeconds {
  double read = 0, textures = 0, build = 0;
  double total() const { return read + textures + build; }
};

void print_summary(const EsvoReport& report, const EsvoSeconds& seconds, const EsvoBuild& build,
                   const Session& session) {
  const double rate = static_cast<double>(report.metadata.counts.voxels()) / seconds.build;
  if (session.json) {
    nlohmann::ordered_json json = esvo_json(report);
    json["seconds"] = {{"read", seconds.read},
                       {"textures", seconds.textures},
                       {"build", seconds.build},
                       {"total", seconds.total()}};
    json["voxels_per_second"] = rate;
    json["peak_memory_bytes"] = peak_memory_bytes();
    fmt::print("{}", json_text(json));
    return;
  }
  if (session.quiet) return;
  fmt::print(
      "{}: {}\n{}\n"
      "  time          {}: read {}, textures {}, build and write {}\n"
      "  rate          {} voxels/s\n"
      "  peak memory   {}\n",
      build.output, human_bytes(report.file_bytes), esvo_table(report),
      human_seconds(seconds.total()), human_seconds(seconds.read), human_seconds(seconds.textures),
      human_seconds(seconds.build), human_count(rate), human_bytes(peak_memory_bytes()));
  if (build.stats) fmt::print("\n{}", esvo_level_table(report));
}

}  // namespace

void add_esvo_options(CLI::App& command, EsvoArguments& arguments) {
  EsvoSettings& settings = arguments.options.settings;
  const auto add = [&](const std::string& name, auto& value, double most, const std::string& shape,
                       const std::string& help) {
    command.add_option(name, value, help)
        ->check(number_from(0, most))
        ->type_name(shape)
        ->capture_default_str()
        ->group("ESVO");
  };
  add("--max-error", settings.max_error, 1e6, "VOXELS",
      "How far a leaf's shape may reach beyond the surface, in voxels of the finest level");
  add("--color-error", settings.color_error, 1.0, "DIFFERENCE",
      "How much colours may differ in a leaf: greatest difference of a channel, 0 to 1 (sRGB)");
  add("--normal-error", arguments.normal_degrees, 180.0, "DEGREES",
      "How much normals may differ in a leaf");
  add_displace_option(command, arguments.displace);
  add_no_displacement_option(command, arguments.displace);
  add_bake_options(command, arguments.bake);
  command
      .add_flag_callback(
          "--no-contours", [&settings] { settings.contours = false; },
          "Cubes of the finest level only, as in a DAG")
      ->group("ESVO");
  command
      .add_flag_callback(
          "--no-attributes", [&settings] { settings.attributes = false; },
          "The shape alone: no colours, no normals")
      ->excludes("--bake-ao")
      ->group("ESVO");
}

void build_esvo_file(const EsvoArguments& arguments, const EsvoBuild& build, Session& session) {
  Progress& progress = session.progress;
  Stopwatch watch;
  EsvoSeconds seconds;
  MemoryBudget memory = command_budget(build.memory_limit);
  MeshWithAppearance source = read_mesh_with_appearance(session.subject, &progress);
  const MemoryReservation source_memory(&memory, bytes_of(source));
  print_warnings(source.warnings, session);
  seconds.read = watch.lap();
  std::vector<std::string> warnings;
  const SurfaceShading shading(source.mesh, source.appearance, &warnings, &progress, &memory);
  const std::optional<DisplacedTriangles> displaced = open_displaced(
      arguments.displace, source.mesh, source.appearance, warnings, progress, &memory);
  print_warnings(warnings, session);
  seconds.textures = watch.lap();

  EsvoOptions options = arguments.options;
  options.memory = &memory;
  options.settings.normal_error =
      static_cast<float>(arguments.normal_degrees * std::numbers::pi / 180);
  const DisplacedTriangles* const moved = displaced ? &*displaced : nullptr;
  EsvoMetadata metadata;
  const std::optional<Box3d> bounds =
      displaced ? std::optional(displaced_bounds(*displaced, source.mesh)) : std::nullopt;
  metadata.grid = build.choose_grid(source.mesh, bounds);
  metadata.source = {std::filesystem::path(session.subject).filename().string(),
                     source.mesh.vertices.size(), source.mesh.triangles.size()};
  metadata.program = "voxdag " VOXDAG_VERSION;
  metadata.build = settings_of(arguments, build);
  if (displaced) metadata.build["displaced"] = "yes";
  std::optional<Occluders> occluders;
  if (arguments.bake.rays > 0 && options.settings.attributes) {
    add_bake_settings(arguments.bake, metadata.grid, metadata.build);
    occluders.emplace(source.mesh, metadata.grid, arguments.bake, options, shading, moved,
                      progress);
    options.settings.light = occluders->light();
  }
  EsvoReport report;
  {
    EsvoFileWriter writer(build.output);
    FileSink sink(writer);
    EsvoResult result =
        build_esvo(source.mesh, metadata.grid, options, &shading, moved, sink, &progress);
    metadata.root = result.root;
    metadata.counts = result.counts;
    progress.throw_if_cancelled();
    // Not read back: by now the name may be another file's.
    report = {metadata, sink.bytes(), writer.finish(std::move(result.directory), metadata)};
  }
  seconds.build = watch.lap();
  warn_if_empty(metadata.counts.voxels(), build.output, session);
  session.bar.clear();
  print_summary(report, seconds, build, session);
}

}  // namespace voxdag
