#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "lab/reproduce/svdag/flight.hpp"
#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

/// The rates of one caster along the path.
struct Rates {
  double mrays_per_second = NAN;  ///< All frames together.
  std::vector<double> per_frame;
  double agreement = NAN;  ///< With the DAG.
};

/// Returns the rates of voxdag, or of those rivals whose names start with `rival`: the fastest.
Rates rates_of(const FlightRun& run, const std::string& rays, const std::string& rival) {
  Rates best;
  if (!run.result.failure.empty()) return best;
  for (const Json& row : run.result.json) {
    if (row.at("rays") != rays) continue;
    if (rival.empty()) return {row.at("mrays_per_s"), row.at("view_mrays_per_s"), 1};
    if (row.at("rival").is_null() || !row.at("rival").get<std::string>().starts_with(rival))
      continue;
    const double rate = row.at("rival_mrays_per_s");
    if (best.per_frame.empty() || rate > best.mrays_per_second)
      best = {rate, row.at("rival_view_mrays_per_s"), row.at("rival_agreement")};
  }
  return best;
}

ChartLine line_of(const std::string& label, const std::vector<double>& values, int color,
                  LineStyle style = LineStyle::kSolid) {
  ChartLine line;
  line.label = label;
  line.color = color;
  line.style = style;
  line.y = values;
  for (std::size_t i = 0; i < values.size(); ++i) line.x.push_back(static_cast<double>(i));
  return line;
}

constexpr const char* kCpuCheck = "voxdag_cpu";
constexpr const char* kTrianglesName = "triangles (Embree, on the processor)";

enum Color { kDag = 0, kTriangles = 1, kEsvo = 2, kVoxels = 3, kCones = 4 };

constexpr const char* kToVoxels = "DAG, to voxels";
constexpr const char* kToCones = "DAG, to 0.07 sr";

ChartPanel rate_panel(std::string title, std::vector<ChartLine> lines) {
  return {std::move(title), {"frame", {}}, {"million rays per second", {}}, std::move(lines)};
}

/// Returns the milliseconds for a million rays.
std::vector<double> milliseconds(std::vector<double> mrays_per_second) {
  for (double& value : mrays_per_second) value = 1000 / value;
  return mrays_per_second;
}

/// A row of a table: a caster's rate, its ratio to the DAG's, and how often they agree.
std::vector<std::string> rate_row(const std::string& name, const Rates& rates, const Rates& dag) {
  return {name, number_text(rates.mrays_per_second),
          number_text(dag.mrays_per_second / rates.mrays_per_second),
          std::isnan(rates.agreement) ? "–" : fmt::format("{:.1f} %", 100 * rates.agreement)};
}

/// Returns a row for rays that end elsewhere, so that agreement says nothing.
std::vector<std::string> other_row(const std::string& name, const Rates& rates, const Rates& dag) {
  std::vector<std::string> row = rate_row(name, rates, dag);
  row.back() = "other rays";
  return row;
}

/// Returns the rates of the DAG on the processor, with which Embree compares.
Rates rates_on_cpu(const FlightRun& run, const std::string& rays) {
  const Rates check = rates_of(run, rays, kCpuCheck);
  return check.per_frame.empty() ? rates_of(run, rays, "") : check;
}

/// Adds the row of Embree, whose ratio is to the DAG on the processor. Adds that DAG's row too if
/// a CUDA device cast the other rays.
void add_triangles(Table& table, const FlightRun& run, const std::string& rays) {
  const Rates dag = rates_of(run, rays, ""), cpu = rates_on_cpu(run, rays);
  if (!rates_of(run, rays, kCpuCheck).per_frame.empty())
    table.rows.push_back(rate_row("DAG, on the processor", cpu, dag));
  table.rows.push_back(rate_row(kTrianglesName, rates_of(run, rays, "embree"), cpu));
}

Table rate_table(std::string caption) {
  return {
      std::move(caption),
      {"cast at", "million rays per second", "DAG is faster by", "rays that agree with the DAG"},
      {}};
}

void add_run(Section& section, const FlightRun& run) {
  section.parts.emplace_back(CommandLine{command_of(run.cell)});
  if (!run.result.failure.empty())
    section.parts.emplace_back(Paragraph{"Not measured: " + run.result.failure + "."});
}

void add_chart(Section& section, const char* file, const std::string& caption, bool is_drawn) {
  if (is_drawn) section.parts.emplace_back(Picture{caption, file});
}

std::string where(const Flight& flight, const FlightRun& run) {
  return fmt::format("{} ({}) at {}", flight.scene.scene->name, flight.scene.state(),
                     short_resolution(run.levels));
}

Section figure6(const Flight& flight, bool is_drawn) {
  Section section{"Figure 6: primary rays in a fly-through", 2, {}};
  section.parts.emplace_back(Paragraph{fmt::format(
      "{} frames of {} × {} pixels along a camera path. The DAG and the ESVO use beams, whose time "
      "counts. All cast the same recorded rays; rays end at cells of one pixel, as in pictures. "
      "Embree casts them on the processor, from the eye: single rays or packets of 16, whichever "
      "is faster; its ratio is to the DAG on the processor. The paper measured a GPU (GTX480 and "
      "GTX680), so its figures do not stand beside ours.",
      flight.plan.frames, flight.plan.size.width, flight.plan.size.height)});
  const FlightRun& coarse = flight.with_esvo;
  const FlightRun& fine = flight.with_triangles;
  const Rates dag = rates_of(coarse, "primary_beams", "");
  Table table = rate_table("Primary rays, " + where(flight, coarse));
  table.rows = {rate_row("DAG", dag, dag),
                rate_row("ESVO", rates_of(coarse, "primary_beams", "esvo"), dag)};
  add_triangles(table, coarse, "primary_beams");
  section.parts.emplace_back(std::move(table));
  const Rates fine_dag = rates_of(fine, "primary_beams", "");
  Table fine_table = rate_table("Primary rays, " + where(flight, fine));
  fine_table.rows = {rate_row("DAG", fine_dag, fine_dag)};
  add_triangles(fine_table, fine, "primary_beams");
  section.parts.emplace_back(std::move(fine_table));
  add_chart(section, "svdag-figure6.svg",
            "Figure 6: primary rays per second in each frame, with beams; left DAG and ESVO, right "
            "DAG and triangles.",
            is_drawn);
  add_run(section, coarse);
  add_run(section, fine);
  return section;
}

Section figure7a(const Flight& flight, bool is_drawn) {
  const FlightRun& run = flight.with_triangles;
  Section section{"Figure 7a: hard shadows in a fly-through", 2, {}};
  section.parts.emplace_back(Paragraph{
      "A shadow ray per pixel towards the sun. Milliseconds are those of a million rays, about the "
      "paper's picture. The paper compares with shadow volumes per triangle (Sintorn and others "
      "2011) on a GPU; the rival here is Embree with the same rays. A shadow map needs a "
      "rasterizer, and one of ours on a CPU would be a rival that nobody uses. By default, "
      "voxdag's rays end "
      "at cells of one pixel; \"to voxels\" is the paper's way."});
  const Rates dag = rates_of(run, "shadow", "");
  Table table = rate_table("Shadow rays, " + where(flight, run));
  table.rows = {rate_row("DAG", dag, dag),
                other_row(kToVoxels, rates_of(flight.with_voxels, "shadow", ""), dag)};
  add_triangles(table, run, "shadow");
  section.parts.emplace_back(std::move(table));
  add_chart(section, "svdag-figure7a.svg",
            "Figure 7a: time for a million shadow rays in each frame.", is_drawn);
  return section;
}

/// Returns the chart of rates over the size of the lamp.
ChartPanel lamp_panel(const Flight& flight) {
  ChartLine with_beams{"with beams", {}, {}, kDag, LineStyle::kSolid, true},
      without{"without beams", {}, {}, kTriangles, LineStyle::kSolid, true};
  if (flight.with_lamps.result.failure.empty())
    for (const Json& row : flight.with_lamps.result.json) {
      if (row.at("rays") != "soft_lamp") continue;
      with_beams.x.push_back(row.at("light_size"));
      with_beams.y.push_back(row.at("mrays_per_s"));
      without.x.push_back(row.at("light_size"));
      without.y.push_back(row.at("rival_mrays_per_s"));
    }
  return {where(flight, flight.with_lamps),
          {"radius of the lamp / its distance", {}},
          {"million rays per second", {}},
          {with_beams, without}};
}

Section figure7b(const Flight& flight, bool is_drawn) {
  Section section{"Figure 7b: soft shadows and the size of the light", 2, {}};
  section.parts.emplace_back(Paragraph{
      "16 rays per pixel towards a sphere, over all frames, on the processor. With beams, a beam "
      "from each pixel to "
      "the light shortens its rays or makes them unnecessary. The rate counts the rays that are "
      "needed without beams, and the time includes the beams."});
  const ChartPanel panel = lamp_panel(flight);
  Table table{"Soft shadow rays, " + panel.title,
              {"radius / distance", "with beams (Mrays/s)", "without beams (Mrays/s)",
               "beams are faster by"},
              {}};
  for (std::size_t i = 0; i < panel.lines[0].x.size(); ++i)
    table.rows.push_back({fmt::format("{:g}", panel.lines[0].x[i]),
                          number_text(panel.lines[0].y[i]), number_text(panel.lines[1].y[i]),
                          number_text(panel.lines[0].y[i] / panel.lines[1].y[i])});
  section.parts.emplace_back(std::move(table));
  add_chart(section, "svdag-figure7b.svg",
            "Figure 7b: soft shadow rays per second over the lamp's size.", is_drawn);
  add_run(section, flight.with_lamps);
  return section;
}

Section figure8a(const Flight& flight, bool is_drawn) {
  Section section{"Figure 8a: ambient occlusion in a fly-through", 2, {}};
  section.parts.emplace_back(Paragraph{
      "64 rays per pixel; a part of the pixels is measured. By default, voxdag's occlusion rays "
      "end at cells as large as the surface's cell, which is one pixel. The paper's end at voxels, "
      "or at the first cell that subtends 0.07 steradians (9 degrees) from the surface: both are "
      "beside the default."});
  const FlightRun& run = flight.with_triangles;
  const Rates dag = rates_of(run, "ao", "");
  Table table = rate_table("Occlusion rays, " + where(flight, run));
  table.rows = {rate_row("DAG", dag, dag),
                other_row(kToVoxels, rates_of(flight.with_voxels, "ao", ""), dag),
                other_row(kToCones, rates_of(flight.with_cones, "ao", ""), dag)};
  add_triangles(table, run, "ao");
  section.parts.emplace_back(std::move(table));
  add_chart(section, "svdag-figure8a.svg", "Figure 8a: occlusion rays per second in each frame.",
            is_drawn);
  add_run(section, flight.with_voxels);
  add_run(section, flight.with_cones);
  return section;
}

}  // namespace

Json run_json(const FlightRun& run) {
  Json json{{"command", command_of(run.cell)}, {"resolution", std::int64_t{1} << run.levels}};
  if (run.result.failure.empty())
    json["rows"] = run.result.json;
  else
    json["failure"] = run.result.failure;
  return json;
}

double mrays_per_second(const FlightRun& run, const std::string& rays) {
  return rates_of(run, rays, "").mrays_per_second;
}

double speed_ratio(const FlightRun& run, const std::string& rays, const std::string& rival) {
  const Rates dag = rival == "embree" ? rates_on_cpu(run, rays) : rates_of(run, rays, "");
  return dag.mrays_per_second / rates_of(run, rays, rival).mrays_per_second;
}

std::vector<Section> flight_sections(const Flight& flight, bool is_drawn) {
  return {figure6(flight, is_drawn), figure7a(flight, is_drawn), figure7b(flight, is_drawn),
          figure8a(flight, is_drawn)};
}

std::vector<Chart> flight_charts(const Flight& flight) {
  const FlightRun& coarse = flight.with_esvo;
  const FlightRun& fine = flight.with_triangles;
  const auto frames = [](const FlightRun& run, const char* rays, const char* rival) {
    return rates_of(run, rays, rival).per_frame;
  };
  const char* const beams = "primary_beams";
  Chart figure6{
      "svdag-figure6.svg",
      {rate_panel(where(flight, coarse), {line_of("DAG", frames(coarse, beams, ""), kDag),
                                          line_of("ESVO", frames(coarse, beams, "esvo"), kEsvo)}),
       rate_panel(where(flight, fine),
                  {line_of("DAG", frames(fine, beams, ""), kDag),
                   line_of(kTrianglesName, frames(fine, beams, "embree"), kTriangles)})}};
  Chart figure7a{
      "svdag-figure7a.svg",
      {{where(flight, fine),
        {"frame", {}},
        {"ms for a million shadow rays", {}},
        {line_of("DAG", milliseconds(frames(fine, "shadow", "")), kDag),
         line_of(kToVoxels, milliseconds(frames(flight.with_voxels, "shadow", "")), kVoxels),
         line_of(kTrianglesName, milliseconds(frames(fine, "shadow", "embree")), kTriangles)}}}};
  Chart figure8a{"svdag-figure8a.svg",
                 {rate_panel(where(flight, fine),
                             {line_of("DAG", frames(fine, "ao", ""), kDag),
                              line_of(kToVoxels, frames(flight.with_voxels, "ao", ""), kVoxels),
                              line_of(kToCones, frames(flight.with_cones, "ao", ""), kCones),
                              line_of(kTrianglesName, frames(fine, "ao", "embree"), kTriangles)})}};
  Chart figure7b{"svdag-figure7b.svg", {lamp_panel(flight)}};
  return {figure6, figure7a, figure7b, figure8a};
}

Json flight_json(const Flight& flight) {
  return {{"scene", flight.scene.scene->name},
          {"state", flight.scene.state()},
          {"with_esvo", run_json(flight.with_esvo)},
          {"with_triangles", run_json(flight.with_triangles)},
          {"with_voxels", run_json(flight.with_voxels)},
          {"with_lamps", run_json(flight.with_lamps)},
          {"with_cones", run_json(flight.with_cones)}};
}

}  // namespace voxdag::lab
