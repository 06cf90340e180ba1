/// Prints the results of `voxdag bench esvo`.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "lab/esvo/bench_esvo.hpp"
#include "lab/papers/esvo_published.hpp"
#include "lab/papers/paper_json.hpp"
#include "lab/report/bench_machine.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;
using Builds = std::vector<EsvoBuildRun>;

std::string number(double value, int digits) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, digits);
}

Json json_number(double value) { return std::isnan(value) ? Json() : Json(value); }

std::string resolution_of(int levels) { return with_commas(std::uint64_t{1} << levels) + "³"; }

std::string build_row(const EsvoBuildRun& run) {
  const std::string name = fmt::format("{:>10}  {:<9}", resolution_of(run.levels),
                                       run.with_contours ? "contours" : "cubes");
  if (!run.failure.empty()) return fmt::format("  {} failed: {}\n", name, run.failure);
  const published::EsvoScene* scene = published::esvo_scene(run.paper);
  const double times_paper =
      run.voxels_per_cpu_second() / published::esvo_voxels_per_core_second(scene, run.levels);
  const published::EsvoScene* paper = run.with_contours ? scene : nullptr;
  const double megabytes =
      paper != nullptr ? published::esvo_of_levels(paper->megabytes, run.levels) : NAN;
  const double seconds =
      paper != nullptr ? published::esvo_of_levels(paper->seconds, run.levels) : NAN;
  return fmt::format("  {}{:>15}{:>10}{:>8}{:>10}{:>10}{:>14}{:>9}{:>12}{:>10}{:>9}\n", name,
                     with_commas(run.voxels), number(run.megabytes(), 1),
                     number(run.bytes_per_voxel(), 2), number(run.build_seconds, 2),
                     number(run.cost.cpu_seconds(), 2), human_count(run.voxels_per_cpu_second()),
                     number(times_paper, 1), human_bytes(run.cost.peak_bytes), number(megabytes, 0),
                     number(seconds, 0));
}

std::string builds_table(const Builds& builds) {
  std::string text;
  for (std::size_t i = 0; i < builds.size(); ++i) {
    if (i == 0 || builds[i].scene != builds[i - 1].scene) {
      const PaperMatch& match = builds[i].paper;
      const published::EsvoScene* paper = published::esvo_scene(match);
      text += fmt::format("{}{}{}{}\n", i == 0 ? "" : "\n", builds[i].scene,
                          match.scene == nullptr ? "" : " (" + match.label() + ")",
                          paper == nullptr ? ""
                                           : fmt::format("; the paper: {:.2f} bytes per voxel",
                                                         paper->bytes_per_voxel));
      text +=
          fmt::format("  {:>10}  {:<9}{:>15}{:>10}{:>8}{:>10}{:>10}{:>14}{:>9}{:>12}{:>10}{:>9}\n",
                      "grid", "form", "voxels", "MB", "B/voxel", "build s", "CPU s", "voxels/CPU s",
                      "x paper", "peak mem", "paper MB", "paper s");
    }
    text += build_row(builds[i]);
  }
  return text;
}

/// The first form that is an octree; triangles are always cast on the CPU.
constexpr auto kFirstOctreeForm = static_cast<std::size_t>(EsvoForm::kCubes);

std::string size_of(const EsvoRateRow& row) {
  return fmt::format("{}x{}", row.size.width, row.size.height);
}

/// Returns the paper's rate, or NaN.
double paper_mrays(const EsvoRateRow& row, std::size_t form) {
  if (form >= published::kEsvoRates) return NAN;
  return published::esvo_mrays(published::esvo_scene(row.paper), row.levels, row.size.width,
                               row.size.height)[form];
}

std::string rates_table(const EsvoBenchResults& results) {
  const std::vector<EsvoRateRow>& rates = results.rates;
  if (rates.empty()) return "";
  const std::string device =
      results.cuda_device.empty() ? "" : fmt::format(", octrees on {}", results.cuda_device);
  std::string text = fmt::format(
      "\nMillion primary rays per second{} (in brackets: the paper, for octrees of its depth)\n  "
      "{:<16}{:>10}{:>12}",
      device, "scene", "grid", "size");
  for (std::size_t form = 0; form < published::kEsvoRates; ++form)
    text += fmt::format("{:>20}", name_of(kEsvoForms[form]));
  text += "\n";
  for (const EsvoRateRow& row : rates) {
    text += fmt::format("  {:<16}{:>11}{:>12}", row.scene, resolution_of(row.levels), size_of(row));
    for (std::size_t form = 0; form < published::kEsvoRates; ++form) {
      const double paper = paper_mrays(row, form);
      text += fmt::format("{:>20}", number(row.mrays_per_second[form], 2) +
                                        (std::isnan(paper) ? "" : " (" + number(paper, 1) + ")"));
    }
    text += "\n";
  }
  return text;
}

/// Returns the table of the CPU's rates, for rays that a CUDA device cast too.
std::string cpu_table(const EsvoBenchResults& results) {
  if (results.cuda_device.empty()) return "";
  std::string text = "\nMillion primary rays per second of the CPU, with the same rays\n";
  text += fmt::format("  {:<16}{:>10}{:>12}", "scene", "grid", "size");
  for (std::size_t form = kFirstOctreeForm; form < published::kEsvoRates; ++form)
    text += fmt::format("{:>20}", name_of(kEsvoForms[form]));
  text += fmt::format("{:>16}\n", "equal hits");
  for (const EsvoRateRow& row : results.rates) {
    if (!row.on_cuda) continue;
    text += fmt::format("  {:<16}{:>11}{:>12}", row.scene, resolution_of(row.levels), size_of(row));
    for (std::size_t form = kFirstOctreeForm; form < published::kEsvoRates; ++form)
      text += fmt::format("{:>20}", number(row.cpu_mrays_per_second[form], 2));
    text += fmt::format("{:>16}\n", number(row.least_agreement_with_cpu(), 6));
  }
  return text;
}

/// Returns the table of the coarse forms, as multiples of the cubes' rate.
std::string coarse_table(const EsvoBenchResults& results) {
  const auto coarse_of = [&](const EsvoRateRow& row) {
    return coarse_levels(results.silhouettes, row.scene);
  };
  if (std::all_of(results.rates.begin(), results.rates.end(),
                  [&](const EsvoRateRow& row) { return coarse_of(row) == 0; }))
    return "";
  std::string text = fmt::format(
      "\nMillion primary rays per second, on the coarsest grid of contours whose silhouettes are "
      "as good as those of the cubes; x cubes: multiples of the cubes' rate\n"
      "  {:<16}{:>16}{:>12}{:>12}{:>18}{:>18}{:>14}\n",
      "scene", "grid of cubes", "contours", "size", "contours", "with beams", "x cubes");
  for (const EsvoRateRow& row : results.rates) {
    const int coarse = coarse_of(row);
    if (coarse == 0) continue;
    const auto rate = [&row](EsvoForm form) {
      return row.mrays_per_second[static_cast<std::size_t>(form)];
    };
    const double cubes = rate(EsvoForm::kCubes), contours = rate(EsvoForm::kCoarseContours),
                 beams = rate(EsvoForm::kCoarseContoursBeams);
    text += fmt::format("  {:<16}{:>17}{:>13}{:>12}{:>18}{:>18}{:>14}\n", row.scene,
                        resolution_of(row.levels), resolution_of(coarse), size_of(row),
                        number(contours, 2), number(beams, 2),
                        number(contours / cubes, 2) + ", " + number(beams / cubes, 2));
  }
  return text;
}

std::string pictures_table(const std::vector<EsvoRateRow>& rates) {
  if (rates.empty()) return "";
  std::string text = fmt::format(
      "\nSeconds of the pictures of all views, without shadows and occlusion\n"
      "  {:<16}{:>10}{:>12}{:>20}{:>20}{:>12}\n",
      "scene", "grid", "size", "casts with beams", "casts and shading", "filter");
  for (const EsvoRateRow& row : rates)
    text += fmt::format("  {:<16}{:>11}{:>12}{:>20}{:>20}{:>12}\n", row.scene,
                        resolution_of(row.levels), size_of(row), number(row.cast_seconds(), 3),
                        number(row.seconds.picture, 3), number(row.seconds.filter, 3));
  return text;
}

std::string silhouettes_table(const std::vector<SilhouetteRow>& rows) {
  if (rows.empty()) return "";
  std::string text = fmt::format(
      "\nRays on the wrong side of a silhouette, per million\n  {:<16}{:>10}{:>12}{:>12}{:>26}\n",
      "scene", "grid", "cubes", "contours", "levels of cubes saved");
  for (const SilhouetteRow& row : rows) {
    const LevelsSaved saved = levels_saved(rows, row);
    text += fmt::format("  {:<16}{:>11}{:>12}{:>12}{:>26}\n", row.scene, resolution_of(row.levels),
                        number(row.cubes * 1e6, 0), number(row.contours * 1e6, 0),
                        (saved.at_least ? "> " : "") + number(saved.levels, 1));
  }
  return text;
}

}  // namespace

std::string name_of(EsvoForm form) {
  static constexpr std::array kNames{"triangles",      "cubes",           "contours",
                                     "contours_beams", "coarse_contours", "coarse_contours_beams"};
  static_assert(kNames.size() == kEsvoForms.size());
  return kNames[static_cast<std::size_t>(form)];
}

double EsvoRateRow::least_agreement_with_cpu() const {
  double least = 1;
  for (const double part : agreement_with_cpu)
    if (part < least) least = part;  // false for NaN
  return least;
}

int coarse_levels(const std::vector<SilhouetteRow>& rows, const std::string& scene) {
  const SilhouetteRow* finest = nullptr;
  for (const SilhouetteRow& row : rows)
    if (row.scene == scene) finest = &row;
  for (const SilhouetteRow& row : rows)
    if (row.scene == scene && row.contours <= finest->cubes)
      return row.levels < finest->levels ? row.levels : 0;
  return 0;
}

LevelsSaved levels_saved(const std::vector<SilhouetteRow>& rows, const SilhouetteRow& row) {
  // Without wrong rays there is nothing to compare.
  if (row.cubes == 0) return {0, true};
  const bool are_better = row.contours < row.cubes;
  const SilhouetteRow* before = nullptr;
  for (const SilhouetteRow& next : rows) {
    if (next.scene != row.scene || (are_better && next.levels < row.levels)) continue;
    if (next.cubes <= row.contours) {
      if (before == nullptr) return {static_cast<double>(next.levels - row.levels)};
      const double whole = std::log(before->cubes / next.cubes);
      const double part = next.cubes == 0 ? 1
                          : whole > 0     ? std::log(before->cubes / row.contours) / whole
                                          : 0;
      return {before->levels + part * (next.levels - before->levels) - row.levels};
    }
    before = &next;
  }
  return {static_cast<double>(before != nullptr ? before->levels - row.levels : 0), true};
}

Json esvo_bench_json(const EsvoBenchResults& results, const Json& machine) {
  Json json{{"program", program_name()}, {"machine", machine}, {"threads", results.threads}};
  json["published"] = published::kEsvoSource;
  json["builds"] = Json::array();
  for (const EsvoBuildRun& run : results.builds) {
    Json object{{"scene", run.scene},
                {"resolution", std::int64_t{1} << run.levels},
                {"levels", run.levels},
                {"contours", run.with_contours},
                {"load_before", run.load_before}};
    add_paper_scene(object, run.paper);
    if (!run.failure.empty()) {
      object["failure"] = run.failure;
      json["builds"].push_back(object);
      continue;
    }
    object["voxels"] = run.voxels;
    object["bytes"] = run.bytes;
    object["bytes_per_voxel"] = run.bytes_per_voxel();
    object["contour_count"] = run.contours;
    object["far_pointers"] = run.far_pointers;
    object["read_seconds"] = run.read_seconds;
    object["build_seconds"] = run.build_seconds;
    object["wall_seconds"] = run.cost.wall_seconds;
    object["cpu_seconds"] = run.cost.cpu_seconds();
    object["voxels_per_second"] = run.voxels_per_second();
    object["voxels_per_cpu_second"] = run.voxels_per_cpu_second();
    object["peak_memory_bytes"] = run.cost.peak_bytes;
    const published::EsvoScene* paper = published::esvo_scene(run.paper);
    if (paper != nullptr && run.with_contours)
      object["paper"] = {
          {"megabytes", json_number(published::esvo_of_levels(paper->megabytes, run.levels))},
          {"build_seconds", json_number(published::esvo_of_levels(paper->seconds, run.levels))},
          {"bytes_per_voxel", paper->bytes_per_voxel},
          {"voxels_per_core_second",
           json_number(published::esvo_voxels_per_core_second(paper, run.levels))}};
    json["builds"].push_back(object);
  }
  json["rays"] = Json::array();
  for (const EsvoRateRow& row : results.rates) {
    const int coarse = coarse_levels(results.silhouettes, row.scene);
    Json object{{"scene", row.scene},
                {"resolution", std::int64_t{1} << row.levels},
                {"coarse_resolution", coarse == 0 ? Json() : Json(std::int64_t{1} << coarse)},
                {"width", row.size.width},
                {"height", row.size.height},
                {"device", row.on_cuda ? "cuda" : "cpu"},
                {"device_name", row.on_cuda ? Json(results.cuda_device) : machine.at("processor")},
                {"ray_count", row.rays},
                {"picture_seconds", row.seconds.picture},
                {"filter_seconds", json_number(row.seconds.filter)}};
    for (const EsvoForm form : kEsvoForms) {
      const auto at = static_cast<std::size_t>(form);
      object[name_of(form)] = {{"mrays_per_s", json_number(row.mrays_per_second[at])},
                               {"agreement_with_triangles", json_number(row.agreement[at])},
                               {"paper_mrays_per_s", json_number(paper_mrays(row, at))},
                               {"cpu_mrays_per_s", json_number(row.cpu_mrays_per_second[at])},
                               {"agreement_with_cpu", json_number(row.agreement_with_cpu[at])}};
    }
    json["rays"].push_back(object);
  }
  json["silhouettes"] = Json::array();
  for (const SilhouetteRow& row : results.silhouettes) {
    const LevelsSaved saved = levels_saved(results.silhouettes, row);
    json["silhouettes"].push_back({{"scene", row.scene},
                                   {"resolution", std::int64_t{1} << row.levels},
                                   {"cubes_wrong", row.cubes},
                                   {"contours_wrong", row.contours},
                                   {"levels_saved", saved.levels},
                                   {"levels_saved_is_least", saved.at_least}});
  }
  return json;
}

std::string esvo_bench_table(const EsvoBenchResults& results) {
  return builds_table(results.builds) + rates_table(results) + cpu_table(results) +
         coarse_table(results) + pictures_table(results.rates) +
         silhouettes_table(results.silhouettes);
}

}  // namespace voxdag::lab
