#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "bench/compact_rays/compact_rays.hpp"
#include "voxdag/report/human.hpp"

namespace voxdag {
namespace {

double million_per_second(std::size_t count, double seconds) {
  return static_cast<double>(count) / seconds / 1e6;
}

double part(const CompactRaysPoint& point, const CompactRaysResults& results) {
  return static_cast<double>(point.bytes) / static_cast<double>(results.plain_bytes);
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
    json["plain"][std::string(name_of(kCompactRayClasses[c]))] = {
        {"rays", results.rays[c]},
        {"seconds", results.plain_seconds[c]},
        {"packet_seconds", results.packet_seconds[c]}};
  json["compact"] = nlohmann::ordered_json::array();
  for (const CompactRaysPoint& point : results.points) {
    nlohmann::ordered_json row = {{"tables", point.tables},
                                  {"bytes", point.bytes},
                                  {"part_of_plain", part(point, results)},
                                  {"encode_seconds", point.encode_seconds},
                                  {"decode_seconds", point.decode_seconds}};
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c)
      row[std::string(name_of(kCompactRayClasses[c]))] = {
          {"seconds", point.ray_seconds[c]},
          {"time_ratio", point.ray_seconds[c] / results.plain_seconds[c]},
          {"decoded_per_ray", point.units_per_ray[c]}};
    json["compact"].push_back(row);
  }
  return json;
}

std::string compact_rays_table(const CompactRaysResults& results) {
  std::string text = fmt::format(
      "{}, {}³: {} in the plain form, {} nodes\n\n"
      "Million rays/s, and the time as a ratio to single rays at the plain form:\n\n"
      "  {:<14}{:>10}{:>8}{:>10}{:>10}{:>18}{:>18}{:>18}\n",
      results.scene, with_commas(std::uint64_t{1} << results.levels),
      human_bytes(results.plain_bytes), with_commas(results.nodes), "", "size", "part", "encode s",
      "decode s", "primary", "shadow", "occlusion");
  const auto row = [&](const std::string& name, const std::string& left, const double* seconds) {
    text += fmt::format("  {:<14}{}", name, left);
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c)
      text += fmt::format(
          "{:>18}", fmt::format("{:.2f} ({:.2f})", million_per_second(results.rays[c], seconds[c]),
                                seconds[c] / results.plain_seconds[c]));
    text += '\n';
  };
  const std::string plain =
      fmt::format("{:>10}{:>8.3f}{:>10}{:>10}", human_bytes(results.plain_bytes), 1.0, "", "");
  row("plain", plain, results.plain_seconds);
  row("  in packets", plain, results.packet_seconds);
  for (const CompactRaysPoint& point : results.points)
    row(fmt::format("{} tables", point.tables),
        fmt::format("{:>10}{:>8.3f}{:>10.2f}{:>10.2f}", human_bytes(point.bytes),
                    part(point, results), point.encode_seconds, point.decode_seconds),
        point.ray_seconds);
  text +=
      fmt::format("\n  cache of decoded nodes: {} per thread; units and bricks decoded per ray:",
                  human_bytes(results.cache_bytes));
  if (!results.points.empty())
    for (const double units : results.points.back().units_per_ray)
      text += fmt::format(" {:.3f}", units);
  return text + '\n';
}

Chart compact_rays_chart(const CompactRaysResults& results, const std::filesystem::path& file) {
  ChartPanel panel;
  panel.title = fmt::format("{}, {}³", results.scene, std::uint64_t{1} << results.levels);
  panel.x.label = "bytes, as part of the plain form";
  panel.y.label = "time per ray, as ratio to the plain form";
  constexpr const char* kNames[] = {"primary", "shadow", "occlusion"};
  for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
    ChartLine line{kNames[c], {}, {}, static_cast<int>(c)};
    line.markers = true;
    for (const CompactRaysPoint& point : results.points) {
      line.x.push_back(part(point, results));
      line.y.push_back(point.ray_seconds[c] / results.plain_seconds[c]);
    }
    panel.lines.push_back(std::move(line));
  }
  return {file, {panel}};
}

}  // namespace voxdag
