#include "lab/reproduce/bench_papers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <thread>

#include "lab/report/bench_machine.hpp"
#include "lab/report/scratch_folder.hpp"
#include "lab/reproduce/esvo/esvo_chapter.hpp"
#include "lab/reproduce/svdag/svdag_chapter.hpp"
#include "voxdag/cluster/rank_queue.hpp"
#include "voxdag/cluster/ranks_per_machine.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kItemCounter = 0;

/// The ranks that shared the runs.
struct Sharing {
  int ranks = 1, most_on_a_machine = 1;
};

std::string sharing_text(const Sharing& sharing) {
  if (sharing.most_on_a_machine == 1)
    return fmt::format("{} processes, each on a machine of its own, shared the runs.",
                       sharing.ranks);
  return fmt::format(
      "{} processes shared the runs, up to {} on one machine at one time: their runs disturbed one "
      "another, so times are longer, and rates lower, than those of a machine with one process.",
      sharing.ranks, sharing.most_on_a_machine);
}

Section machine_section(const Json& machine, int threads, const PapersDevice& device,
                        const Sharing& sharing) {
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
  if (sharing.ranks > 1) section.parts.emplace_back(Paragraph{sharing_text(sharing)});
  return section;
}

/// Returns the scan of the SVDAG paper.
FoundScene scan_of(const std::vector<FoundScene>& scenes) {
  for (const FoundScene& scene : scenes)
    if (scene.scene->name == "Lucy") return scene;
  return {};
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder, "", "cannot make the folder: " + error.message());
}

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Throws Error if the times of this rank's machine do not belong beside those of rank 0's.
/// Collective.
void check_machine(const std::string& machine, Ranks& ranks) {
  std::vector<std::byte> first = bytes_of(machine);
  ranks.broadcast(first);
  if (bytes_of(machine) == first) return;
  const auto on_one_line = [](std::string text) {
    std::replace(text.begin(), text.end(), '\n', ';');
    return text;
  };
  throw Error(
      fmt::format("a report needs machines of one kind: rank {} has \"{}\", rank 0 has "
                  "\"{}\"",
                  ranks.rank(), on_one_line(machine), on_one_line(text_of(first))));
}

/// The scenes of the papers.
struct PaperScenes {
  std::vector<FoundScene> svdag, esvo;
};

/// Finds the scenes on rank 0 first, whose runs the others find kept. Collective.
PaperScenes find_all_scenes(const PapersPlan& plan, const fs::path& made, CellStore& cells,
                            Ranks& ranks, Progress& progress) {
  if (ranks.rank() != 0) ranks.barrier();
  PaperScenes scenes{find_scenes(Paper::kSvdag, plan, made, cells, progress),
                     find_scenes(Paper::kEsvo, plan, made, cells, progress)};
  if (ranks.rank() == 0) ranks.barrier();
  return scenes;
}

/// Makes all runs of the report, each on one of the ranks. Collective.
void share_runs(const PapersPlan& plan, const PaperScenes& scenes, CellStore& cells, Ranks& ranks,
                Progress& progress) {
  std::vector<RunItem> items = svdag_items(plan, scenes.svdag, cells, progress);
  for (RunItem& item : esvo_items(plan, scenes.esvo, scan_of(scenes.svdag), cells, progress))
    items.push_back(std::move(item));
  RankQueue(ranks, kItemCounter).run(items.size(), 0, [&](std::size_t i, std::span<std::byte>) {
    progress.report("runs", static_cast<double>(i) / static_cast<double>(items.size()), i);
    items[i]();
  });
}

/// Adds the runs of the other ranks to those of rank 0, and returns the number of each rank's runs.
/// Collective.
std::vector<std::size_t> gather_measured(CellStore& cells, Ranks& ranks) {
  std::string keys;
  for (const std::string& key : cells.measured_keys()) keys += key + "\n";
  std::vector<std::vector<std::byte>> outgoing(ranks.count());
  outgoing[0] = bytes_of(keys);
  std::vector<std::size_t> counts;
  for (const std::vector<std::byte>& of_rank : ranks.exchange(std::move(outgoing))) {
    std::istringstream lines(text_of(of_rank));
    std::size_t count = 0;
    for (std::string key; std::getline(lines, key); ++count) cells.add_measured(key);
    counts.push_back(count);
  }
  return counts;
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

PapersReport bench_papers(const PapersPlan& wanted, Ranks& ranks, Progress& progress) {
  const Sharing sharing{ranks.count(), ranks_per_machine(ranks).most};
  const ScratchFolder made;
  PapersPlan plan = wanted;
  make_folder(plan.folder);
  const ScratchFolder scratch(plan.folder);
  plan.scratch = scratch.path();
  plan.device = find_device(plan.device_choice, made.path(), progress);
  CellStore cells(plan.folder / "cells", plan.scratch, sharing.most_on_a_machine, progress);
  check_machine(cells.machine() + "\n" + plan.device.name, ranks);
  const PaperScenes scenes = find_all_scenes(plan, made.path(), cells, ranks, progress);
  PapersReport report;
  if (ranks.count() > 1) {
    share_runs(plan, scenes, cells, ranks, progress);
    report.measured_by = gather_measured(cells, ranks);
    if (ranks.rank() != 0) return {};
  }
  // With several ranks, all results are kept ones now.
  const SvdagResults svdag = measure_svdag(plan, scenes.svdag, cells, progress);
  const EsvoResults esvo = measure_esvo(plan, scenes.esvo, scan_of(scenes.svdag), cells, progress);

  std::vector<Chart> charts = svdag_charts(svdag);
  for (Chart& chart : esvo_charts(esvo)) charts.push_back(std::move(chart));
  progress.report("drawing charts", 1);
  report.has_charts = draw_charts(charts, plan.folder, progress);

  const Json machine = machine_json();
  const int threads =
      plan.threads > 0 ? plan.threads : static_cast<int>(std::thread::hardware_concurrency());
  Document document{"The papers, measured again",
                    {machine_section(machine, threads, plan.device, sharing)}};
  for (const auto& chapter : {svdag_chapter(svdag, threads, report.has_charts),
                              esvo_chapter(esvo, threads, report.has_charts)})
    document.sections.insert(document.sections.end(), chapter.begin(), chapter.end());

  const Json json{
      {"program", program_name()},
      {"machine", machine},
      {"ranks", sharing.ranks},
      {"ranks_on_a_machine", sharing.most_on_a_machine},
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

}  // namespace voxdag::lab
