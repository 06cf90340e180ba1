#include "bench/reproduce/bench_papers.hpp"

#include <fmt/core.h>

#include <thread>

#include "bench/report/bench_machine.hpp"
#include "bench/report/scratch_folder.hpp"
#include "bench/reproduce/esvo/esvo_chapter.hpp"
#include "bench/reproduce/svdag/svdag_chapter.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/io/atomic_file.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Section machine_section(const Json& machine, int threads, const PapersDevice& device) {
  Section section{"The machine", 2, {}};
  section.parts.emplace_back(Paragraph{fmt::format(
      "{}, {} threads, {:.0f} GiB of memory, {}. Measured by {} until {}.",
      machine.at("processor").get<std::string>(), threads,
      machine.at("memory_bytes").get<double>() / (1 << 30), machine.at("system").get<std::string>(),
      program_name(), machine.at("time").get<std::string>())});
  section.parts.emplace_back(Paragraph{
      device.is_cuda()
          ? fmt::format("{} casts the rays at voxels and renders the pictures. The processor "
                        "builds, casts rays at triangles (Embree), and measures silhouettes and "
                        "Figure 7b of the SVDAG paper.{}",
                        device.name,
                        device.option == "auto"
                            ? " It also does what needs more memory than the device has; the "
                              "results in the file report.json name the device of each run."
                            : "")
          : std::string("The processor casts all rays and renders the pictures.")});
  return section;
}

/// Returns the scan of the SVDAG paper.
FoundScene scan_of(const std::vector<FoundScene>& scenes) {
  for (const FoundScene& scene : scenes)
    if (scene.scene->name == "Lucy") return scene;
  return {};
}

}  // namespace

double typical_seconds(const PapersPlan& plan) {
  // Seconds measured at 4K and 8K with 1024 x 768 pixels; each frame of the lamps' run costs as
  // much as so many others for each lamp.
  constexpr double kScenes = 5, kFlightRuns = 4, kLampCost = 2;
  constexpr double kFrameSeconds = 5, kPictureSeconds = 10, kRaysPerBuild = 4;
  const double pixels = static_cast<double>(plan.flight.size.width) * plan.flight.size.height;
  const double frames = plan.flight.frames *
                        (kFlightRuns + kLampCost * static_cast<double>(plan.flight.lamps.size()));
  const auto builds = [&](BuildKind kind, const std::vector<int>& levels) {
    return typical_seconds(plan, kind, levels);
  };
  // `bench esvo` builds cubes, too, and casts rays.
  const double per_scene =
      builds(BuildKind::kPaper, plan.table1_levels) + builds(BuildKind::kHash, plan.table1_levels) +
      builds(BuildKind::kHash, plan.table2_levels) + builds(BuildKind::kEsvo, plan.table2_levels) +
      builds(BuildKind::kShape, plan.table2_levels) +
      (1 + kRaysPerBuild) * builds(BuildKind::kEsvo, plan.esvo.levels) + 2 * kPictureSeconds;
  return kScenes * per_scene + frames * kFrameSeconds * pixels / (1024 * 768);
}

PapersReport bench_papers(const PapersPlan& wanted, Progress& progress) {
  const ScratchFolder made;
  PapersPlan plan = wanted;
  plan.device = find_device(plan.device_choice, made.path(), progress);
  CellStore cells(plan.folder / "cells", progress);
  const SvdagResults svdag = measure_svdag(plan, made.path(), cells, progress);
  const EsvoResults esvo = measure_esvo(plan, scan_of(svdag.scenes), made.path(), cells, progress);

  PapersReport report;
  std::vector<Chart> charts = svdag_charts(svdag);
  for (Chart& chart : esvo_charts(esvo)) charts.push_back(std::move(chart));
  progress.report("drawing charts", 1);
  report.has_charts = draw_charts(charts, plan.folder, progress);

  const Json machine = machine_json();
  const int threads =
      plan.threads > 0 ? plan.threads : static_cast<int>(std::thread::hardware_concurrency());
  Document document{"The papers, measured again", {machine_section(machine, threads, plan.device)}};
  for (const auto& chapter : {svdag_chapter(svdag, threads, report.has_charts),
                              esvo_chapter(esvo, threads, report.has_charts)})
    document.sections.insert(document.sections.end(), chapter.begin(), chapter.end());

  const Json json{
      {"program", program_name()},
      {"machine", machine},
      {"device", plan.device.is_cuda() ? "cuda" : "cpu"},
      {"device_name", plan.device.is_cuda() ? Json(plan.device.name) : machine.at("processor")},
      {"svdag", svdag_json(svdag)},
      {"esvo", esvo_json(esvo)}};
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
