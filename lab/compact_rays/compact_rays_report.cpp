/// Writes the results of `voxdag bench compact-rays` as JSON.
#include <nlohmann/json.hpp>

#include "lab/compact_rays/compact_rays.hpp"

namespace voxdag::lab {
namespace {

double part(const CompactRaysPoint& point, const CompactRaysResults& results) {
  return static_cast<double>(point.bytes) / static_cast<double>(results.plain_bytes);
}

nlohmann::ordered_json json_of(const TouchedMemory& touched) {
  return {{"bytes", touched.bytes}, {"lines", touched.lines}, {"symbols", touched.symbols}};
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

}  // namespace voxdag::lab
