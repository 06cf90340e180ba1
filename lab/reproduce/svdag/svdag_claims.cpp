#include "lab/reproduce/svdag/svdag_claims.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "lab/reproduce/claims_table.hpp"

namespace voxdag::lab {
namespace {

double reduction_seconds(const CellResult& result) { return stage_seconds(result, "reduce"); }

/// Calls add(scene, levels) for each scene of the paper, or variant of one, and each of `levels`.
template <class Add>
void for_each_build(const std::vector<SvdagSceneBuilds>& scenes, SeriesMember series,
                    const Add& add) {
  for (const SvdagSceneBuilds& scene : scenes)
    if (scene.scene.match.has_figures())
      for (const SeriesRun& build : scene.*series) add(scene, build.levels);
}

/// Returns a / b for all builds that have both.
template <class ReadA, class ReadB>
std::vector<ClaimValue> ratios(const std::vector<SvdagSceneBuilds>& scenes, SeriesMember series_a,
                               const ReadA& a, SeriesMember series_b, const ReadB& b) {
  std::vector<ClaimValue> values;
  for_each_build(scenes, series_a, [&](const SvdagSceneBuilds& scene, int levels) {
    const double ratio =
        value_at(scene.*series_a, levels, a) / value_at(scene.*series_b, levels, b);
    if (!std::isnan(ratio))
      values.push_back({fmt::format("{} at {}", scene.scene.scene->name, short_resolution(levels)),
                        levels, ratio});
  });
  return values;
}

/// Returns the values at the highest resolution of each scene.
std::vector<ClaimValue> at_highest(const std::vector<ClaimValue>& values) {
  std::vector<ClaimValue> highest;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i + 1 == values.size() || values[i + 1].levels <= values[i].levels)
      highest.push_back(values[i]);
  return highest;
}

constexpr const char* kNotSoHigh = "not measured at 64K³";

/// Returns whether a scene was measured at the paper's highest resolution.
bool has_paper_levels(const std::vector<ClaimValue>& values) {
  constexpr int kPaperLevels = 16;
  return std::any_of(values.begin(), values.end(),
                     [](const ClaimValue& value) { return value.levels >= kPaperLevels; });
}

/// Adds a claim about the largest value, which the paper found at 64K³.
void add_most(ClaimsTable& claims, const char* claim, double published,
              const std::vector<ClaimValue>& values) {
  const std::string number = number_text(published) + " at 64K³";
  if (values.empty()) return claims.add_unmeasured(claim, number.c_str());
  const ClaimValue& most = *std::max_element(values.begin(), values.end(), is_less);
  const bool is_there = most.value > 0.95 * published;
  claims.add(claim, number.c_str(), text_of(most),
             most.value > published                 ? "exceeded"
             : is_there || has_paper_levels(values) ? verdict(is_there)
                                                    : kNotSoHigh);
}

/// Returns the growth of the reduction from each resolution above 1024³ to the next.
std::vector<ClaimValue> reduction_growth(const std::vector<SvdagSceneBuilds>& scenes) {
  constexpr int kFirstWithSubvolumes = 11;
  std::vector<ClaimValue> growth;
  for_each_build(
      scenes, &SvdagSceneBuilds::by_paper, [&](const SvdagSceneBuilds& scene, int levels) {
        const double from = value_at(scene.by_paper, levels, reduction_seconds),
                     to = value_at(scene.by_paper, levels + 1, reduction_seconds);
        if (levels >= kFirstWithSubvolumes && !std::isnan(from) && !std::isnan(to))
          growth.push_back({fmt::format("{}, {} to {}", scene.scene.scene->name,
                                        short_resolution(levels), short_resolution(levels + 1)),
                            levels, to / from});
      });
  return growth;
}

/// Adds the claim about the sizes at the highest resolutions. In the paper, too, the SVO of Lucy is
/// smaller than its DAG up to 16K³.
void add_svo_claim(ClaimsTable& claims, const std::vector<ClaimValue>& against_svo) {
  const char* const claim = "The DAG is smaller than the SVO without pointers (SVO / DAG)";
  const char* const published = "above 1 in every scene at 64K³";
  const std::vector<ClaimValue> highest = at_highest(against_svo);
  if (highest.empty()) return claims.add_unmeasured(claim, published);
  const bool holds = std::all_of(highest.begin(), highest.end(),
                                 [](const ClaimValue& value) { return value.value > 1; });
  claims.add(claim, published, range_text(highest),
             holds || has_paper_levels(highest) ? verdict(holds) : kNotSoHigh);
}

void add_speed(ClaimsTable& claims, const char* claim, const char* published, double ratio,
               double least) {
  if (std::isnan(ratio)) return claims.add_unmeasured(claim, published);
  claims.add(claim, published, fmt::format("{:.2f} times as fast", ratio), verdict(ratio >= least));
}

}  // namespace

Section svdag_claims_section(const std::vector<SvdagSceneBuilds>& scenes,
                             const std::optional<Flight>& flight) {
  using Builds = SvdagSceneBuilds;
  const std::vector<ClaimValue> merging =
      ratios(scenes, &Builds::dags, svo_nodes, &Builds::dags, dag_nodes);
  const std::vector<ClaimValue> against_svo =
      ratios(scenes, &Builds::dags, svo_nodes, &Builds::dags, dag_bytes);
  const std::vector<ClaimValue> against_esvo =
      ratios(scenes, &Builds::esvos, esvo_bytes, &Builds::dags, dag_bytes);
  ClaimsTable claims;
  claims.add_range("Merging reduces the nodes by one to three orders of magnitude (SVO / DAG)",
                   "28 to 576 at the highest resolutions", at_highest(merging),
                   [](double factor) { return factor >= 10; });
  add_most(claims, "Largest reduction of nodes (SVO / DAG)", 576, merging);
  add_most(claims, "Largest saving against the SVO without pointers (SVO / DAG)", 26, against_svo);
  add_svo_claim(claims, against_svo);
  claims.add_range("The DAG is smaller than the ESVO at every resolution (ESVO / DAG)",
                   "above 1 everywhere", against_esvo, [](double factor) { return factor > 1; });
  add_most(claims, "Largest saving against the ESVO (ESVO / DAG)", 38, against_esvo);
  claims.add_range("The time of the reduction scales with the surface: about 4 per level",
                   "3.3 to 5", reduction_growth(scenes), [](double factor) { return factor <= 5; });
  const double none = NAN;
  add_speed(claims, "Primary rays with beams: slightly faster than the ESVO", "above 1 on average",
            flight ? speed_ratio(flight->with_esvo, "primary_beams", "esvo") : none, 1);
  add_speed(claims, "Primary rays: as fast as triangles even at high resolutions", "about 1",
            flight ? speed_ratio(flight->with_triangles, "primary_beams", "embree") : none, 0.9);
  add_speed(claims, "Occlusion rays: at least as fast as triangles", "above 1",
            flight ? speed_ratio(flight->with_triangles, "ao", "embree") : none, 1);
  Section section{"Claims", 2, {}};
  section.parts.emplace_back(Paragraph{
      "Sizes and times are those of the paper's scenes and their variants. Ratios of speeds are "
      "those of the fly-through below, on the device named above. Ratios to triangles are those of "
      "the processor, with Embree as the tracer of triangles. The paper measured GPUs."});
  section.parts.emplace_back(claims.take("Claims of the paper"));
  return section;
}

}  // namespace voxdag::lab
