#include "bench/reproduce/svdag_claims.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/reproduce/table_text.hpp"

namespace voxdag {
namespace {

double reduction_seconds(const CellResult& result) { return stage_seconds(result, "reduce"); }

/// A value of one scene at one resolution.
struct Value {
  std::string where;  ///< "Lucy at 4K³".
  int levels = 0;
  double value = 0;
};

/// Calls add(scene, levels) for each scene of the paper, or variant of one, and each of `levels`.
template <class Add>
void for_each_build(const std::vector<SvdagSceneBuilds>& scenes, SeriesMember series,
                    const Add& add) {
  for (const SvdagSceneBuilds& scene : scenes)
    if (scene.scene.match.has_figures())
      for (const SeriesBuild& build : scene.*series) add(scene, build.levels);
}

/// Returns a / b for all builds that have both.
template <class ReadA, class ReadB>
std::vector<Value> ratios(const std::vector<SvdagSceneBuilds>& scenes, SeriesMember series_a,
                          const ReadA& a, SeriesMember series_b, const ReadB& b) {
  std::vector<Value> values;
  for_each_build(scenes, series_a, [&](const SvdagSceneBuilds& scene, int levels) {
    const double ratio =
        value_at(scene.*series_a, levels, a) / value_at(scene.*series_b, levels, b);
    if (!std::isnan(ratio))
      values.push_back({fmt::format("{} at {}", scene.scene.scene->name, resolution_text(levels)),
                        levels, ratio});
  });
  return values;
}

bool is_less(const Value& a, const Value& b) { return a.value < b.value; }

/// Returns the values at the highest resolution of each scene.
std::vector<Value> at_highest(const std::vector<Value>& values) {
  std::vector<Value> highest;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i + 1 == values.size() || values[i + 1].levels <= values[i].levels)
      highest.push_back(values[i]);
  return highest;
}

std::string text_of(const Value& value) {
  return fmt::format("{} ({})", number_text(value.value), value.where);
}

/// Returns "3.1 (Lucy at 2K³) to 109 (Crysponza at 4K³)".
std::string range_text(const std::vector<Value>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end(), is_less);
  return least == most ? text_of(*least) : text_of(*least) + " to " + text_of(*most);
}

constexpr const char* kNotSoHigh = "not measured at 64K³";

/// Returns whether a scene was measured at the paper's highest resolution.
bool has_paper_levels(const std::vector<Value>& values) {
  constexpr int kPaperLevels = 16;
  return std::any_of(values.begin(), values.end(),
                     [](const Value& value) { return value.levels >= kPaperLevels; });
}

const char* verdict(bool is_reproduced) { return is_reproduced ? "reproduced" : "not reproduced"; }

class Claims {
 public:
  Claims() : table_{"", {"claim", "published", "measured here", "verdict"}, {}, 4} {}

  void add(const char* claim, const char* published, const std::string& ours, const char* result) {
    table_.rows.push_back({claim, published, ours, result});
  }
  void add_unmeasured(const char* claim, const char* published) {
    add(claim, published, "–", "not measured");
  }
  /// Adds a claim about all values: it is reproduced if `holds` for each.
  template <class Holds>
  void add_range(const char* claim, const char* published, const std::vector<Value>& values,
                 const Holds& holds) {
    if (values.empty()) return add_unmeasured(claim, published);
    add(claim, published, range_text(values),
        verdict(std::all_of(values.begin(), values.end(),
                            [&](const Value& v) { return holds(v.value); })));
  }
  /// Adds a claim about the largest value, which the paper found at 64K³.
  void add_most(const char* claim, double published, const std::vector<Value>& values) {
    const std::string number = number_text(published) + " at 64K³";
    if (values.empty()) return add_unmeasured(claim, number.c_str());
    const Value& most = *std::max_element(values.begin(), values.end(), is_less);
    const bool is_there = most.value > 0.95 * published;
    add(claim, number.c_str(), text_of(most),
        most.value > published                 ? "exceeded"
        : is_there || has_paper_levels(values) ? verdict(is_there)
                                               : kNotSoHigh);
  }
  Table take(std::string caption) {
    table_.caption = std::move(caption);
    return std::move(table_);
  }

 private:
  Table table_;
};

/// Returns the growth of the reduction from each resolution above 1024³ to the next.
std::vector<Value> reduction_growth(const std::vector<SvdagSceneBuilds>& scenes) {
  constexpr int kFirstWithSubvolumes = 11;
  std::vector<Value> growth;
  for_each_build(
      scenes, &SvdagSceneBuilds::by_paper, [&](const SvdagSceneBuilds& scene, int levels) {
        const double from = value_at(scene.by_paper, levels, reduction_seconds),
                     to = value_at(scene.by_paper, levels + 1, reduction_seconds);
        if (levels >= kFirstWithSubvolumes && !std::isnan(from) && !std::isnan(to))
          growth.push_back({fmt::format("{}, {} to {}", scene.scene.scene->name,
                                        resolution_text(levels), resolution_text(levels + 1)),
                            levels, to / from});
      });
  return growth;
}

/// Adds the claim about the sizes at the highest resolutions. In the paper, too, the SVO of Lucy is
/// smaller than its DAG up to 16K³.
void add_svo_claim(Claims& claims, const std::vector<Value>& against_svo) {
  const char* const claim = "The DAG is smaller than the SVO without pointers (SVO / DAG)";
  const char* const published = "above 1 in every scene at 64K³";
  const std::vector<Value> highest = at_highest(against_svo);
  if (highest.empty()) return claims.add_unmeasured(claim, published);
  const bool holds = std::all_of(highest.begin(), highest.end(),
                                 [](const Value& value) { return value.value > 1; });
  claims.add(claim, published, range_text(highest),
             holds || has_paper_levels(highest) ? verdict(holds) : kNotSoHigh);
}

void add_speed(Claims& claims, const char* claim, const char* published, double ratio,
               double least) {
  if (std::isnan(ratio)) return claims.add_unmeasured(claim, published);
  claims.add(claim, published, fmt::format("{:.2f} times as fast", ratio), verdict(ratio >= least));
}

}  // namespace

Section svdag_claims_section(const std::vector<SvdagSceneBuilds>& scenes,
                             const std::optional<Flight>& flight) {
  using Builds = SvdagSceneBuilds;
  const std::vector<Value> merging =
      ratios(scenes, &Builds::dags, svo_nodes, &Builds::dags, dag_nodes);
  const std::vector<Value> against_svo =
      ratios(scenes, &Builds::dags, svo_nodes, &Builds::dags, dag_bytes);
  const std::vector<Value> against_esvo =
      ratios(scenes, &Builds::esvos, esvo_bytes, &Builds::dags, dag_bytes);
  Claims claims;
  claims.add_range("Merging reduces the nodes by one to three orders of magnitude (SVO / DAG)",
                   "28 to 576 at the highest resolutions", at_highest(merging),
                   [](double factor) { return factor >= 10; });
  claims.add_most("Largest reduction of nodes (SVO / DAG)", 576, merging);
  claims.add_most("Largest saving against the SVO without pointers (SVO / DAG)", 26, against_svo);
  add_svo_claim(claims, against_svo);
  claims.add_range("The DAG is smaller than the ESVO at every resolution (ESVO / DAG)",
                   "above 1 everywhere", against_esvo, [](double factor) { return factor > 1; });
  claims.add_most("Largest saving against the ESVO (ESVO / DAG)", 38, against_esvo);
  claims.add_range("The time of the reduction scales with the surface: about 4 per level",
                   "3.3 to 5", reduction_growth(scenes), [](double factor) { return factor <= 5; });
  const double none = NAN;
  add_speed(claims, "Primary rays with beams: slightly faster than the ESVO", "above 1 on average",
            flight ? speed_ratio(flight->with_esvo, "primary_beams", "esvo") : none, 1);
  add_speed(claims, "Primary rays: as fast as triangles even at high resolutions", "about 1",
            flight ? speed_ratio(flight->with_triangles, "primary_beams", "embree") : none, 0.8);
  add_speed(claims, "Occlusion rays: at least as fast as triangles", "above 1",
            flight ? speed_ratio(flight->with_triangles, "ao", "embree") : none, 1);
  Section section{"Claims", 2, {}};
  section.parts.emplace_back(Paragraph{
      "Sizes and times are those of the paper's scenes and their variants. Ratios of speeds are "
      "those of the fly-through below, on this machine's processor and with Embree as the tracer "
      "of triangles; the paper measured GPUs."});
  section.parts.emplace_back(claims.take("Claims of the paper"));
  return section;
}

}  // namespace voxdag
