/// `voxdag build` for DAGs.
#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "build/build_arguments.hpp"
#include "cli/input_files.hpp"
#include "cli/output_files.hpp"
#include "cli/stopwatch.hpp"
#include "voxdag/builders/attributes/cut_alpha.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/file/model/written_by.hpp"
#include "voxdag/file/report/dag_report.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/mesh/has_colors.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"
#include "voxdag/mesh/mesh_memory.hpp"
#include "voxdag/stored/compact/compact_bytes.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::cli {
namespace {

/// Wall-clock seconds of the steps of a build.
struct StageSeconds {
  double read = 0, build = 0, solid = 0, attributes = 0, compact = 0, write = 0;
  double total() const { return read + build + solid + attributes + compact + write; }
};

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
                     {"solid", seconds.solid},
                     {"attributes", seconds.attributes},
                     {"compact", seconds.compact},
                     {"write", seconds.write},
                     {"total", seconds.total()}};
  json["voxels_per_second"] = static_cast<double>(dag.metadata.counts.voxels) / seconds.build;
  json["peak_memory_bytes"] = peak_resident_bytes();
  return json;
}

std::string table_of(const DagReport& dag, const StageSeconds& seconds) {
  const double rate = static_cast<double>(dag.metadata.counts.voxels) / seconds.build;
  return fmt::format(
      "{}\n"
      "  time          {}: read {}, build {}, {}{}{}write {}\n"
      "  rate          {} voxels/s\n"
      "  peak memory   {}\n",
      dag_table(dag), human_seconds(seconds.total()), human_seconds(seconds.read),
      human_seconds(seconds.build),
      seconds.solid > 0 ? "solid " + human_seconds(seconds.solid) + ", " : "",
      seconds.attributes > 0 ? "attributes " + human_seconds(seconds.attributes) + ", " : "",
      dag.compact ? fmt::format("compact {}, ", human_seconds(seconds.compact)) : "",
      human_seconds(seconds.write), human_count(rate), human_bytes(peak_resident_bytes()));
}

/// Returns the DAG with the voxels inside. Errors name the mesh and what else could be done.
Svdag fill(const SvdagView& cover, const Mesh& mesh, const Grid& grid,
           const BuildArguments& arguments, Work work, Session& session) {
  const SolidOptions options{*arguments.solid, arguments.winding_threshold, arguments.by_centre};
  try {
    return fill_solid(cover, mesh, grid, options, work);
  } catch (const Cancelled&) {
    throw;
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    throw Error(session.subject, "",
                error.reason() + (options.rule == SolidRule::kParity
                                      ? "; --solid winding fills such meshes, too"
                                      : "; --solid flood fills what its voxels enclose"));
  }
}

}  // namespace

void warn_of_parts_outside(const BuildArguments& arguments, const Mesh& mesh, const Grid& grid,
                           Session& session) {
  if (arguments.grid_of.empty() || mesh.triangles.empty()) return;
  const Box3d of_mesh = referenced_bounds(mesh), of_grid = grid.bounds();
  const double rounding = grid.voxel_size / 1000;
  bool reaches_out = false, meets = true;
  for (int axis = 0; axis < 3; ++axis) {
    reaches_out = reaches_out || of_mesh.lo[axis] < of_grid.lo[axis] - rounding ||
                  of_mesh.hi[axis] > of_grid.hi[axis] + rounding;
    meets = meets && of_mesh.hi[axis] >= of_grid.lo[axis] && of_mesh.lo[axis] <= of_grid.hi[axis];
  }
  if (reaches_out && meets)
    print_warnings({fmt::format("{}: reaches from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, "
                                "{:.6g}), out of the grid of {}: what lies outside is left out",
                                session.subject, of_mesh.lo.x, of_mesh.lo.y, of_mesh.lo.z,
                                of_mesh.hi.x, of_mesh.hi.y, of_mesh.hi.z, arguments.grid_of)},
                   session);
}

void build_dag_file(BuildArguments arguments, Session& session) {
  check_writable(arguments.output);
  Stopwatch watch;
  StageSeconds seconds;

  MemoryBudget memory = command_budget(arguments.memory_limit);
  const Work work(&memory, &session.progress);
  MeshAccess access = arguments.access;
  access.memory = &memory;
  access.objects = arguments.attributes.options.materials;
  JoinedMeshes meshes =
      read_mesh_files(arguments.meshes, arguments.attributes.needs_appearance(), access, session);
  MeshWithAppearance& source = meshes.source;
  Mesh& mesh = source.mesh;
  if (arguments.attributes.options.colors && !has_colors(source.appearance))
    print_warnings({session.subject + ": has no colours: --color stores one " +
                    (is_white(source.appearance) ? "white" : "grey") + " for all cells"},
                   session);
  if (arguments.attributes.options.has_channels() && !has_metallic_roughness(source.appearance))
    print_warnings({session.subject + ": has no metallic and no roughness: --channel stores 0 and "
                                      "1 for all cells"},
                   session);
  if (arguments.attributes.colors_if_any)
    arguments.attributes.options.colors |= has_colors(source.appearance);
  arguments.attributes.colors_if_any = false;
  const bool needs_appearance = arguments.attributes.needs_appearance();
  NamedIds ids;
  if (access.objects) ids = named_ids(arguments.attributes.ids, meshes, arguments.meshes, &memory);
  seconds.read = watch.lap();

  DagReport report;
  report.metadata.grid = grid_of_build(arguments, mesh, arguments.grid);
  warn_of_rounding(session.subject, mesh, report.metadata.grid.voxel_size, session);
  warn_of_parts_outside(arguments, mesh, report.metadata.grid, session);
  arguments.attributes.check_levels(report.metadata.grid.levels);
  report.metadata.source = {names_of(arguments.meshes), mesh.vertices.size(),
                            mesh.triangles.size()};
  report.metadata.program = written_by();
  report.metadata.build = build_settings(arguments);
  BuildResult result = build_svdag(mesh, report.metadata.grid, arguments.method, work);
  const bool has_attributes = arguments.attributes.is_wanted();
  const auto free_source = [&] {
    memory.release(memory_bytes(mesh) + memory_bytes(source.appearance));
    source = {};
  };
  seconds.build = watch.lap();
  Svdag cover;
  MemoryReservation cover_bytes;
  if (arguments.solid) {
    cover = std::move(result.dag);
    cover_bytes = std::move(result.memory);
    result.dag = fill(cover.view(), mesh, report.metadata.grid, arguments, work, session);
    result.memory = MemoryReservation(&memory, result.dag.view().bytes());
    seconds.solid = watch.lap();
    if (!has_attributes) cover = {}, cover_bytes = {};
  }
  const SvdagView cover_view = cover.view();
  std::optional<SurfaceShading> shading;
  if (needs_appearance) {
    std::vector<std::string> warnings;
    shading.emplace(mesh, source.appearance, &warnings, work,
                    arguments.attributes.options.has_channels());
    print_warnings(warnings, session);
  }
  if (arguments.attributes.cuts_alpha()) {
    auto cut = cut_alpha(mesh, report.metadata.grid, result.dag.view(), *shading, work);
    if (cut) {
      result.dag = std::move(*cut);
      result.memory = MemoryReservation(&memory, result.dag.view().bytes());
      report.metadata.build["alpha"] = "cut";
    }
    seconds.attributes = watch.lap();
  }
  if (!has_attributes) {
    shading.reset();
    free_source();
  }

  work.poll();
  const SvdagView view = result.dag.view();
  MemoryReservation counting(&memory, view.bytes());
  report.metadata.counts = count_svdag(view);
  counting.resize(0);
  report = report_of(view, report.metadata, 0);
  work.poll();
  DagAttributes attributes;
  if (has_attributes) {
    watch.lap();
    const MemoryReservation dag_bytes(&memory, view.bytes());
    attributes = build_wanted_attributes(arguments.attributes, source, ids, view,
                                         arguments.solid ? &cover_view : nullptr,
                                         shading ? &*shading : nullptr, report.metadata, work);
    cover = {}, cover_bytes = {};
    seconds.attributes += watch.lap();
    shading.reset();
    free_source();
  }
  report.metadata.presentation = with_home(arguments.presentation(), view, report.metadata.grid);
  work.poll();
  report.attributes = sizes_of(attributes.view());
  if (arguments.compact) {
    const MemoryReservation attribute_bytes(&memory, attributes.bytes());
    const CompactSvdag compact = encode_svdag(view, {}, work);
    seconds.compact = watch.lap();
    write_vdag(arguments.output, compact, report.metadata, attributes.view());
    report.compact = bytes_of(compact.view(), compact_head(compact).size());
  } else {
    write_vdag(arguments.output, view, report.metadata, attributes.view());
  }
  seconds.write = watch.lap();
  std::error_code unknown;
  report.file_bytes = std::filesystem::file_size(arguments.output, unknown);
  if (unknown) report.file_bytes = 0;  // the output is a pipe or a device

  warn_if_empty(report.metadata.counts.voxels, arguments.output, session);
  session.bar.clear();
  if (session.json) {
    fmt::print("{}", json_text(json_of(report, result.report, seconds)));
  } else if (!session.quiet) {
    fmt::print("{}: {}\n{}{}", with_output_name(arguments.output), human_bytes(report.file_bytes),
               arguments.transform_line(), table_of(report, seconds));
    if (arguments.stats) fmt::print("\n{}", level_table(report.metadata.counts));
  }
}

}  // namespace voxdag::cli
