/// Writes the results of `voxdag bench esvo-rays` as JSON.
#include <cmath>

#include "lab/esvo/esvo_rays.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kNames{"triangles",      "cubes",           "contours",
                            "contours_beams", "coarse_contours", "coarse_contours_beams"};
static_assert(kNames.size() == kEsvoForms.size());

Json number(double value) { return std::isnan(value) ? Json() : Json(value); }

Json row_json(const EsvoRays& results, const EsvoRateRow& row, const std::string& processor) {
  const int coarse = coarse_levels(results.silhouettes);
  Json json{{"resolution", std::int64_t{1} << results.levels},
            {"coarse_resolution", coarse == 0 ? Json() : Json(std::int64_t{1} << coarse)},
            {"width", row.size.width},
            {"height", row.size.height},
            {"device", row.on_cuda ? "cuda" : "cpu"},
            {"device_name", row.on_cuda ? results.cuda_device : processor},
            {"ray_count", row.rays},
            {"picture_seconds", row.seconds.picture},
            {"filter_seconds", number(row.seconds.filter)}};
  for (std::size_t form = 0; form < kNames.size(); ++form)
    json[kNames[form]] = {{"mrays_per_s", number(row.mrays_per_second[form])},
                          {"agreement_with_triangles", number(row.agreement[form])},
                          {"cpu_mrays_per_s", number(row.cpu_mrays_per_second[form])},
                          {"agreement_with_cpu", number(row.agreement_with_cpu[form])}};
  return json;
}

}  // namespace

int coarse_levels(const std::vector<SilhouetteRow>& rows) {
  for (const SilhouetteRow& row : rows)
    if (row.contours <= rows.back().cubes) return row.levels < rows.back().levels ? row.levels : 0;
  return 0;
}

Json esvo_rays_json(const EsvoRays& results, const std::string& processor) {
  Json json{{"rays", Json::array()}, {"silhouettes", Json::array()}};
  for (const EsvoRateRow& row : results.rates)
    json["rays"].push_back(row_json(results, row, processor));
  for (const SilhouetteRow& row : results.silhouettes)
    json["silhouettes"].push_back({{"resolution", std::int64_t{1} << row.levels},
                                   {"cubes_wrong", row.cubes},
                                   {"contours_wrong", row.contours}});
  return json;
}

}  // namespace voxdag::lab
