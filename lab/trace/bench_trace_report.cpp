/// Prints and draws the results of `voxdag bench trace`.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "lab/report/bench_machine.hpp"
#include "lab/trace/bench_trace.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

std::string resolution_of(const TraceRow& row) {
  return with_commas(std::uint64_t{1} << row.levels) + "³";
}

/// Returns whether `row` belongs to the table of the row `before`.
bool is_same_dag(const TraceRow& row, const TraceRow& before) {
  return row.scene == before.scene && row.levels == before.levels && row.layout == before.layout;
}

/// Returns the names of all rivals, each once.
std::vector<std::string> rivals_of(const TraceResults& results) {
  std::vector<std::string> names;
  for (const TraceRow& row : results.rows)
    for (const RivalRate& rival : row.rivals)
      if (std::find(names.begin(), names.end(), rival.name) == names.end())
        names.push_back(rival.name);
  return names;
}

double rate_of(const TraceRow& row, const std::string& rival) {
  for (const RivalRate& rate : row.rivals)
    if (rate.name == rival) return rate.mrays_per_second;
  return NAN;
}

}  // namespace

Json trace_json(const TraceResults& results, const Json& machine) {
  Json array = Json::array();
  for (const TraceRow& row : results.rows) {
    Json object{{"program", program_name()},
                {"scene", row.scene},
                {"resolution", std::int64_t{1} << row.levels},
                {"device", row.on_cuda ? "cuda" : "cpu"},
                {"device_name", row.on_cuda ? Json(results.cuda_device) : machine.at("processor")},
                {"threads", results.threads},
                {"layout", row.layout},
                {"layout_bytes", row.layout_bytes},
                {"rays", std::string(name_of(row.rays))},
                {"size", {results.rays.width, results.rays.height}},
                {"lod_pixels", results.rays.lod_pixels},
                {"beam_pixels", results.rays.beam_pixels},
                {"ao_cone", results.rays.occlusion_cone},
                {"ray_count", row.count},
                {"hit_part", row.hit_part},
                {"cells_per_ray", row.cells_per_ray},
                {"bytes_per_ray", row.bytes_per_ray},
                {"mrays_per_s", row.mrays_per_second},
                {"view_mrays_per_s", row.view_mrays_per_second}};
    for (const RivalRate& rival : row.rivals) {
      Json with_rival = object;
      with_rival["rival"] = rival.name;
      with_rival["rival_mrays_per_s"] = rival.mrays_per_second;
      with_rival["ratio"] = row.mrays_per_second / rival.mrays_per_second;
      with_rival["rival_agreement"] = rival.agreement;
      with_rival["rival_view_mrays_per_s"] = rival.view_mrays_per_second;
      if (rival.bytes > 0) with_rival["rival_bytes"] = rival.bytes;
      array.push_back(with_rival);
    }
    if (!row.rivals.empty()) continue;
    object["rival"] = nullptr;
    object["rival_mrays_per_s"] = nullptr;
    object["ratio"] = nullptr;
    object["rival_agreement"] = nullptr;
    object["rival_view_mrays_per_s"] = nullptr;
    array.push_back(object);
  }
  for (const SoftShadows& shadows : results.soft_shadows)
    array.push_back({{"program", program_name()},
                     {"scene", shadows.scene},
                     {"resolution", std::int64_t{1} << shadows.levels},
                     {"device", "cpu"},
                     {"device_name", machine.at("processor")},
                     {"threads", results.threads},
                     {"rays", "soft_lamp"},
                     {"size", {results.rays.width, results.rays.height}},
                     {"light_size", shadows.row.light_size},
                     {"ray_count", shadows.row.rays},
                     {"mrays_per_s", shadows.row.mrays_with_beams()},
                     {"rival", "without_beams"},
                     {"rival_mrays_per_s", shadows.row.mrays_without_beams()},
                     {"ratio", shadows.row.no_beam_seconds / shadows.row.beam_seconds}});
  return array;
}

std::string trace_table(const TraceResults& results) {
  std::string text;
  const std::vector<std::string> rivals = rivals_of(results);
  const bool has_device = !results.cuda_device.empty();
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    const TraceRow& row = results.rows[i];
    if (i == 0 || !is_same_dag(row, results.rows[i - 1])) {
      text += fmt::format("{}{} {}, layout {}, {}{}\n", i == 0 ? "" : "\n", row.scene,
                          resolution_of(row), row.layout, human_bytes(row.layout_bytes),
                          has_device && !row.on_cuda ? ", on the CPU" : "");
      text += fmt::format("  {:<14}{:>12}{:>8}{:>11}{:>11}{:>10}", "rays", "count", "hit",
                          "cells/ray", "bytes/ray", "Mrays/s");
      for (const std::string& rival : rivals) text += fmt::format("{:>24}", rival);
      text += "\n";
    }
    text += fmt::format("  {:<14}{:>12}{:>8.2f}{:>11.1f}{:>11.0f}{:>10.2f}", name_of(row.rays),
                        with_commas(row.count), row.hit_part, row.cells_per_ray, row.bytes_per_ray,
                        row.mrays_per_second);
    for (const std::string& rival : rivals) {
      const double rate = rate_of(row, rival);
      text += std::isnan(rate)
                  ? fmt::format("{:>24}", "-")
                  : fmt::format("{:>15.2f} ({:>5.2f}x)", rate, row.mrays_per_second / rate);
    }
    text += "\n";
  }
  if (!results.soft_shadows.empty())
    text += "\n  soft shadows of a lamp; its radius in parts of its distance\n  " +
            fmt::format("{:<14}{:>12}{:>20}{:>20}\n", "radius", "rays", "Mrays/s with beams",
                        "without beams");
  for (const SoftShadows& shadows : results.soft_shadows)
    text += fmt::format("  {:<14}{:>12}{:>20.2f}{:>20.2f}\n", shadows.row.light_size,
                        with_commas(shadows.row.rays), shadows.row.mrays_with_beams(),
                        shadows.row.mrays_without_beams());
  for (const std::string& failure : results.failures) text += "\n" + failure + "\n";
  return text;
}

Chart trace_chart(const TraceResults& results, const std::filesystem::path& file) {
  Chart chart{file, {}};
  const std::vector<std::string> rivals = rivals_of(results);
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    const TraceRow& row = results.rows[i];
    if (i == 0 || !is_same_dag(row, results.rows[i - 1])) {
      ChartPanel panel;
      panel.title = fmt::format("{} {}, layout {}", row.scene, resolution_of(row), row.layout);
      panel.y.label = "million rays per second";
      panel.lines.push_back({"voxdag", {}, {}, 0});
      for (const std::string& rival : rivals)
        panel.lines.push_back({rival, {}, {}, static_cast<int>(panel.lines.size())});
      chart.panels.push_back(panel);
    }
    ChartPanel& panel = chart.panels.back();
    panel.groups.emplace_back(name_of(row.rays));
    panel.lines[0].y.push_back(row.mrays_per_second);
    for (std::size_t r = 0; r < rivals.size(); ++r)
      panel.lines[r + 1].y.push_back(rate_of(row, rivals[r]));
  }
  if (chart.panels.empty()) throw Error("there are no rays to plot");
  return chart;
}

}  // namespace voxdag::lab
