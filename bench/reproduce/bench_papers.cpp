#include "bench/reproduce/bench_papers.hpp"

#include <fmt/core.h>

#include <thread>

#include "bench/report/bench_machine.hpp"
#include "bench/report/scratch_folder.hpp"
#include "bench/reproduce/flight.hpp"
#include "bench/reproduce/pictures.hpp"
#include "bench/reproduce/svdag_claims.hpp"
#include "bench/reproduce/svdag_sections.hpp"
#include "bench/reproduce/table_text.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/io/atomic_file.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Section machine_section(const Json& machine, int threads) {
  Section section{"The machine", 2, {}};
  section.parts.emplace_back(Paragraph{fmt::format(
      "{}, {} threads, {:.0f} GiB of memory, {}. Measured by {} until {}.",
      machine.at("processor").get<std::string>(), threads,
      machine.at("memory_bytes").get<double>() / (1 << 30), machine.at("system").get<std::string>(),
      program_name(), machine.at("time").get<std::string>())});
  return section;
}

Section scenes_section(const std::vector<FoundScene>& scenes) {
  Section section{"The scenes", 2, {}};
  section.parts.emplace_back(Paragraph{
      "Published figures stand beside ours only if the mesh is the paper's scene (same) "
      "or another version of it (variant). A stand-in is another model of the same kind."});
  Table table{"Scenes of the SVDAG paper", {"scene", "state", "mesh", "difference"}, {}, 4};
  for (const FoundScene& scene : scenes)
    table.rows.push_back({std::string(scene.scene->name), scene.state(),
                          scene.is_absent() ? "–" : scene.mesh.filename().string(),
                          scene.is_absent() ? "no such mesh was found" : scene.match.difference});
  section.parts.emplace_back(std::move(table));
  return section;
}

/// Appends the charts that were drawn to the section.
void add_charts(Section& section, const std::vector<Chart>& charts, const std::string& caption,
                bool is_drawn) {
  for (const Chart& chart : charts)
    if (is_drawn)
      section.parts.emplace_back(Picture{caption, chart.file});
    else
      section.parts.emplace_back(
          Paragraph{"No chart was drawn, because matplotlib (python3-matplotlib) is not installed. "
                    "report.json has its points."});
}

}  // namespace

double typical_seconds(const PapersPlan& plan) {
  constexpr double kScenes = 5, kFlightRuns = 4;
  // Measured at 4K and 8K with 1024 x 768 pixels.
  constexpr double kFrameSeconds = 5, kPictureSeconds = 10;
  const double pixels = static_cast<double>(plan.flight.size.width) * plan.flight.size.height;
  return kScenes *
             (typical_seconds(plan, BuildKind::kPaper, plan.table1_levels) +
              typical_seconds(plan, BuildKind::kHash, plan.table1_levels) +
              typical_seconds(plan, BuildKind::kHash, plan.table2_levels) +
              typical_seconds(plan, BuildKind::kEsvo, plan.table2_levels) +
              typical_seconds(plan, BuildKind::kShape, plan.table2_levels) + kPictureSeconds) +
         kFlightRuns * plan.flight.frames * kFrameSeconds * pixels / (1024 * 768);
}

PapersReport bench_papers(const PapersPlan& plan, Progress& progress) {
  CellStore cells(plan.folder / "cells", progress);
  const ScratchFolder made;
  const std::vector<FoundScene> scenes =
      find_scenes(Paper::kSvdag, plan.scenes, made.path(), plan.only, cells, progress);
  std::vector<SvdagSceneBuilds> builds;
  for (const FoundScene& scene : scenes)
    builds.push_back(build_svdag_scene(plan, scene, cells, progress));
  const SvdagPictures pictures = render_pictures(plan, scenes, cells, progress);
  const std::optional<Flight> flight = measure_flight(plan, scenes, cells, progress);

  const Json machine = machine_json();
  const int threads =
      plan.threads > 0 ? plan.threads : static_cast<int>(std::thread::hardware_concurrency());
  PapersReport report;
  const std::vector<Chart> figure5 = figure5_charts(builds);
  std::vector<Chart> charts = figure5;
  if (flight)
    for (Chart& chart : flight_charts(*flight)) charts.push_back(std::move(chart));
  progress.report("drawing charts", 1);
  report.has_charts = draw_charts(charts, plan.folder, progress);

  Document document{"The papers, measured again", {}};
  document.sections.push_back(machine_section(machine, threads));
  document.sections.push_back(
      {"High Resolution Sparse Voxel DAGs (Kämpe, Sintorn, Assarsson 2013)", 1, {}});
  document.sections.push_back(scenes_section(scenes));
  document.sections.push_back(svdag_claims_section(builds, flight));
  document.sections.push_back(table1_section(builds, threads));
  document.sections.push_back(table2_section(builds));
  document.sections.push_back(figure5_section());
  add_charts(document.sections.back(), figure5,
             "Figure 5: nodes per level of DAGs of several resolutions, and of the SVO of the "
             "highest one.",
             report.has_charts);
  document.sections.push_back(figure4_section(pictures));
  if (flight)
    for (Section& section : flight_sections(*flight, report.has_charts))
      document.sections.push_back(std::move(section));
  document.sections.push_back(figure8b_section(pictures));

  const Json json{{"program", program_name()},
                  {"machine", machine},
                  {"svdag", svdag_builds_json(builds)},
                  {"flight", flight ? flight_json(*flight) : Json()}};
  report.html = plan.folder / "report.html";
  report.markdown = plan.folder / "report.md";
  report.json = plan.folder / "report.json";
  write_whole_file(report.json, json.dump(2) + "\n");
  write_whole_file(report.markdown, markdown_of(document));
  write_whole_file(report.html, html_of(document, plan.folder));
  report.measured = cells.measured();
  report.kept = cells.kept();
  return report;
}

}  // namespace voxdag
