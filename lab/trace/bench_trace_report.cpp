/// Writes the results of `voxdag bench trace` as JSON.
#include "lab/runs/machine.hpp"
#include "lab/trace/bench_trace.hpp"

namespace voxdag::lab {

using Json = nlohmann::ordered_json;

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
      if (rival.same_place) with_rival["rival_at_embrees_place"] = *rival.same_place;
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

}  // namespace voxdag::lab
