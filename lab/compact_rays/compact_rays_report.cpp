#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/compact_rays/compact_rays.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

double million_per_second(std::size_t count, double seconds) {
  return static_cast<double>(count) / seconds / 1e6;
}

double part(const CompactRaysPoint& point, const CompactRaysResults& results) {
  return static_cast<double>(point.bytes) / static_cast<double>(results.plain_bytes);
}

/// Returns a point with the fastest times at the plain form of all points.
CompactRaysPoint fastest_at_plain(const CompactRaysResults& results) {
  CompactRaysPoint plain = results.points.at(0);
  for (const CompactRaysPoint& point : results.points)
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      const CompactRaysTimes& times = point.times[c];
      CompactRaysTimes& best = plain.times[c];
      best.plain_seconds = std::min(best.plain_seconds, times.plain_seconds);
      best.plain_packet_seconds = std::min(best.plain_packet_seconds, times.plain_packet_seconds);
    }
  return plain;
}

nlohmann::ordered_json json_of(const TouchedMemory& touched) {
  return {{"bytes", touched.bytes}, {"lines", touched.lines}, {"symbols", touched.symbols}};
}

std::string touched_line(const std::string& name,
                         const TouchedMemory (&touched)[kCompactRayClassCount]) {
  std::string text = fmt::format("  {:<14}", name);
  for (const TouchedMemory& memory : touched)
    text += fmt::format("{:>10.0f}{:>8.1f}{:>9.0f}", memory.bytes, memory.lines, memory.symbols);
  return text + '\n';
}

/// Returns a table of what rays read.
std::string touched_table(const CompactRaysResults& results) {
  std::string text = fmt::format(
      "\nBytes, cache lines and symbols per ray that starts with empty caches:\n\n"
      "  {:<14}{:>27}{:>27}{:>27}\n",
      "", "primary", "shadow", "occlusion");
  text += touched_line("plain", results.plain_touched);
  for (const CompactRaysPoint& point : results.points)
    text += touched_line(fmt::format("{} tables", point.tables), point.touched);
  return text;
}

}  // namespace

nlohmann::ordered_json compact_rays_json(const CompactRaysResults& results,
                                         const nlohmann::ordered_json& machine) {
  nlohmann::ordered_json json;
  json["machine"] = machine;
  json["scene"] = results.scene;
  json["levels"] = results.levels;
  json["plain_bytes"] = results.plain_bytes;
  json["dag_nodes"] = results.nodes;
  json["cache_bytes_per_thread"] = results.cache_bytes;
  for (std::size_t c = 0; c < kCompactRayClassCount; ++c)
    json["rays"][std::string(name_of(kCompactRayClasses[c]))] = results.rays[c];
  for (std::size_t c = 0; c < kCompactRayClassCount; ++c)
    json["plain_reads_per_ray"][std::string(name_of(kCompactRayClasses[c]))] =
        json_of(results.plain_touched[c]);
  json["compact"] = nlohmann::ordered_json::array();
  for (const CompactRaysPoint& point : results.points) {
    nlohmann::ordered_json row = {{"tables", point.tables},
                                  {"bytes", point.bytes},
                                  {"part_of_plain", part(point, results)},
                                  {"encode_seconds", point.encode_seconds},
                                  {"decode_seconds", point.decode_seconds},
                                  {"open_seconds", point.open_seconds},
                                  {"open_bytes", point.open_bytes}};
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      const CompactRaysTimes& times = point.times[c];
      row[std::string(name_of(kCompactRayClasses[c]))] = {
          {"plain_seconds", times.plain_seconds},
          {"plain_packet_seconds", times.plain_packet_seconds},
          {"seconds", times.seconds},
          {"packet_seconds", times.packet_seconds},
          {"time_ratio", times.seconds / times.plain_seconds},
          {"packet_time_ratio", times.packet_seconds / times.plain_seconds},
          {"decoded_per_ray", times.units_per_ray},
          {"packet_decoded_per_ray", times.packet_units_per_ray},
          {"reads_per_ray", json_of(point.touched[c])}};
    }
    json["compact"].push_back(row);
  }
  return json;
}

std::string compact_rays_table(const CompactRaysResults& results) {
  std::string text = fmt::format(
      "{}, {}³: {} in the plain form, {} nodes\n\n"
      "Million rays/s, and the time as a ratio to single rays at the plain form in the same "
      "turns:\n\n"
      "  {:<14}{:>10}{:>8}{:>10}{:>10}{:>8}{:>16}{:>16}{:>16}\n",
      results.scene, with_commas(std::uint64_t{1} << results.levels),
      human_bytes(results.plain_bytes), with_commas(results.nodes), "", "size", "part", "encode s",
      "decode s", "open s", "primary", "shadow", "occlusion");
  const auto row = [&](const std::string& name, const std::string& left,
                       const CompactRaysPoint& point, double CompactRaysTimes::*seconds) {
    text += fmt::format("  {:<14}{:<46}", name, left);
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      const double time = point.times[c].*seconds;
      text += fmt::format("{:>16}",
                          fmt::format("{:.2f} ({:.2f})", million_per_second(results.rays[c], time),
                                      time / point.times[c].plain_seconds));
    }
    text += '\n';
  };
  if (results.points.empty()) return text;
  const CompactRaysPoint plain = fastest_at_plain(results);
  row("plain", fmt::format("{:>10}{:>8.3f}", human_bytes(results.plain_bytes), 1.0), plain,
      &CompactRaysTimes::plain_seconds);
  row("  in packets", "", plain, &CompactRaysTimes::plain_packet_seconds);
  for (const CompactRaysPoint& point : results.points) {
    row(fmt::format("{} tables", point.tables),
        fmt::format("{:>10}{:>8.3f}{:>10.2f}{:>10.2f}{:>8.2f}", human_bytes(point.bytes),
                    part(point, results), point.encode_seconds, point.decode_seconds,
                    point.open_seconds),
        point, &CompactRaysTimes::seconds);
    row("  in packets", "", point, &CompactRaysTimes::packet_seconds);
  }
  const CompactRaysPoint& last = results.points.back();
  text += fmt::format(
      "\n  rays at the compact form also need {}, and {} of cache per thread\n"
      "  units decoded per ray, single and in packets:",
      human_bytes(last.open_bytes), human_bytes(results.cache_bytes));
  for (const CompactRaysTimes& times : last.times)
    text += fmt::format(" {:.3f} {:.3f};", times.units_per_ray, times.packet_units_per_ray);
  text.back() = '\n';
  return text + touched_table(results);
}

Chart compact_rays_chart(const CompactRaysResults& results, const std::filesystem::path& file) {
  const auto panel_of = [&](const std::string& name, double CompactRaysTimes::*seconds) {
    ChartPanel panel;
    panel.title =
        fmt::format("{}, {}³: {}", results.scene, std::uint64_t{1} << results.levels, name);
    panel.x.label = "bytes, as part of the plain form";
    panel.y.label = "time / time of single rays at the plain form";
    constexpr const char* kNames[] = {"primary", "shadow", "occlusion"};
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      ChartLine line{kNames[c], {}, {}, static_cast<int>(c)};
      line.markers = true;
      for (const CompactRaysPoint& point : results.points) {
        line.x.push_back(part(point, results));
        line.y.push_back(point.times[c].*seconds / point.times[c].plain_seconds);
      }
      panel.lines.push_back(std::move(line));
    }
    return panel;
  };
  return {file,
          {panel_of("single rays", &CompactRaysTimes::seconds),
           panel_of("packets", &CompactRaysTimes::packet_seconds)}};
}

}  // namespace voxdag::lab
