/// The table, the JSON and the chart of `voxdag bench attributes`.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/attributes/bench_attributes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

std::string title_of(ColorCodec codec) {
  return codec == ColorCodec::kVoxdag     ? "voxdag"
         : codec == ColorCodec::kDolonius ? "Dolonius 2017"
                                          : "ESVO blocks";
}

/// Returns the number, or null if it is not finite.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

double cells_per_second(const AttributesRun& run, double seconds) {
  return static_cast<double>(run.cells) / seconds;
}

Json result_json(const AttributesRun& run, const ColorResult& result) {
  return {{"codec", key_of(result.codec)},
          {"bound", finite_or_null(result.bound)},
          {"bytes", result.bytes},
          {"wire_bytes", result.wire_bytes > 0 ? Json(result.wire_bytes) : Json()},
          {"bits_per_cell", run.bits_per_cell(result)},
          {"bits_per_voxel", run.bits_per_voxel(result.bytes)},
          {"psnr_db", finite_or_null(result.psnr_db)},
          {"ms_ssim", result.ms_ssim},
          {"mean_ms_ssim", result.mean_ms_ssim()},
          {"seconds", result.seconds},
          {"cells_per_second", cells_per_second(run, result.seconds)}};
}

void add_figures(Json& json, const AttributesRun& run) {
  json["voxels"] = run.voxels;
  json["cells"] = run.cells;
  json["index_bytes"] = run.index_bytes;
  json["filter_seconds"] = run.filter_seconds;
  json["filter_cells_per_second"] = cells_per_second(run, run.filter_seconds);
  json["results"] = Json::array();
  for (const ColorResult& result : run.results) json["results"].push_back(result_json(run, result));
}

std::string least_of(const ColorResult& result) {
  return fmt::format("{:.4f}", *std::min_element(result.ms_ssim.begin(), result.ms_ssim.end()));
}

std::string bound_of(const ColorResult& result) {
  return std::isfinite(result.bound) ? fmt::format("{:g}", result.bound) : "";
}

}  // namespace

Json attributes_json(const AttributesResults& results, const Json& machine) {
  return scene_runs_json(results.runs, machine, add_figures);
}

std::string attributes_table(const AttributesResults& results) {
  std::string text;
  for (const AttributesRun& run : results.runs) {
    if (!text.empty()) text += "\n";
    text += fmt::format("{}{}", run.scene,
                        run.levels == 0 ? "" : fmt::format(" {}³", resolution_text(run.levels)));
    if (!run.failure.empty()) {
      text += fmt::format(" failed: {}\n", run.failure);
      continue;
    }
    text += fmt::format(
        ": {} voxels, {} cells, numbers {:.3f} bits/voxel, filtered in {:.2f} s ({} cells/s)\n",
        with_commas(run.voxels), with_commas(run.cells), run.bits_per_voxel(run.index_bytes),
        run.filter_seconds, human_count(cells_per_second(run, run.filter_seconds)));
    text +=
        fmt::format("  {:<13} {:>6} {:>15} {:>13} {:>11} {:>10} {:>9} {:>8} {:>8} {:>9} {:>10}\n",
                    "colours", "bound", "bytes", "wire bytes", "bits/voxel", "bits/cell", "PSNR",
                    "MS-SSIM", "worst", "seconds", "cells/s");
    for (const ColorResult& result : run.results)
      text += fmt::format(
          "  {:<13} {:>6} {:>15} {:>13} {:>11.3f} {:>10.3f} {:>6.2f} dB {:>8.4f} {:>8} {:>9.2f} "
          "{:>10}\n",
          title_of(result.codec), bound_of(result), with_commas(result.bytes),
          result.wire_bytes > 0 ? with_commas(result.wire_bytes) : "",
          run.bits_per_voxel(result.bytes), run.bits_per_cell(result), result.psnr_db,
          result.mean_ms_ssim(), least_of(result), result.seconds,
          human_count(cells_per_second(run, result.seconds)));
  }
  return text;
}

Chart attributes_chart(const AttributesResults& results, const std::filesystem::path& file) {
  Chart chart{file, {}};
  for (const AttributesRun& run : results.runs) {
    if (!run.failure.empty()) continue;
    ChartPanel panel;
    panel.title = fmt::format("{} {}³", run.scene, resolution_text(run.levels));
    panel.x.label = "bits per voxel";
    panel.y.label = "mean MS-SSIM";
    panel.y.from_zero = false;
    for (const ColorCodec codec : kColorCodecs) {
      ChartLine line{title_of(codec), {}, {}, static_cast<int>(codec)};
      line.markers = true;
      for (const ColorResult& result : run.results) {
        if (result.codec != codec) continue;
        line.x.push_back(run.bits_per_voxel(result.bytes));
        line.y.push_back(result.mean_ms_ssim());
      }
      if (!line.x.empty()) panel.lines.push_back(std::move(line));
    }
    if (!panel.lines.empty()) chart.panels.push_back(std::move(panel));
  }
  if (chart.panels.empty()) throw Error("there is nothing to plot");
  return chart;
}

}  // namespace voxdag::lab
