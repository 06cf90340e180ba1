#include <fmt/core.h>

#include <cmath>

#include "lab/reproduce/claims_table.hpp"
#include "lab/reproduce/esvo/esvo_sections.hpp"

namespace voxdag::lab {
namespace {

using Values = std::vector<ClaimValue>;

/// Calls add(scene, run) for each finest run of the paper's scenes and their variants.
template <class Add>
void for_each_finest(const std::vector<EsvoSceneRuns>& scenes,
                     std::vector<SeriesRun> EsvoSceneRuns::*series, const Add& add) {
  for (const EsvoSceneRuns& runs : scenes)
    if (const SeriesRun* finest = finest_of(runs.*series);
        finest != nullptr && runs.scene.match.has_figures())
      add(runs, *finest);
}

/// Returns read(run, size) for each size of the pictures, at the finest resolution of each scene.
template <class Read>
Values per_size(const std::vector<EsvoSceneRuns>& scenes, const Read& read) {
  Values values;
  for_each_finest(
      scenes, &EsvoSceneRuns::rays, [&](const EsvoSceneRuns& runs, const SeriesRun& run) {
        for (const auto& row : run.result.json.at("rays")) {
          const ImageSize size{row.at("width"), row.at("height")};
          const double value = read(run.result, size);
          if (!std::isnan(value))
            values.push_back({fmt::format("{} at {}, {} × {}", runs.scene.scene->name,
                                          short_resolution(run.levels), size.width, size.height),
                              run.levels, value});
        }
      });
  return values;
}

/// Returns the ratios of the rates of two forms.
Values speedups(const std::vector<EsvoSceneRuns>& scenes, EsvoForm form, EsvoForm rival) {
  return per_size(scenes, [&](const CellResult& run, ImageSize size) {
    return esvo_rate(run, size, form) / esvo_rate(run, size, rival);
  });
}

/// Returns how many times as fast as triangles the CPU casts at contours with beams.
Values advantages_over_triangles(const std::vector<EsvoSceneRuns>& scenes) {
  return per_size(scenes, [](const CellResult& run, ImageSize size) {
    return esvo_rate_on_cpu(run, size, EsvoForm::kContoursBeams) /
           esvo_rate(run, size, EsvoForm::kTriangles);
  });
}

Values densities(const std::vector<EsvoSceneRuns>& scenes) {
  Values values;
  for_each_finest(
      scenes, &EsvoSceneRuns::builds, [&](const EsvoSceneRuns& runs, const SeriesRun& run) {
        values.push_back(
            {fmt::format("{} at {}", runs.scene.scene->name, short_resolution(run.levels)),
             run.levels, bytes_per_voxel(run.result)});
      });
  return values;
}

/// Returns the levels that contours save at the coarsest resolution of each scene, which has the
/// most finer ones to compare with.
Values saved_levels(const std::vector<EsvoSceneRuns>& scenes) {
  Values values;
  for (const EsvoSceneRuns& runs : scenes) {
    const std::vector<SilhouetteRow> rows = silhouettes_of(runs);
    if (rows.size() < 2 || !runs.scene.match.has_figures()) continue;
    values.push_back(
        {fmt::format("{} at {}", runs.scene.scene->name, short_resolution(rows.front().levels)),
         rows.front().levels, levels_saved(rows, rows.front()).levels});
  }
  return values;
}

Values filter_advantages(const std::vector<EsvoSceneRuns>& scenes) {
  return per_size(scenes, [](const CellResult& run, ImageSize size) {
    const auto& row = *rays_of_size(run, size);
    return row.at("ray_count").get<double>() * 1e-6 /
           esvo_rate(run, size, EsvoForm::kContoursBeams) / filter_seconds(row);
  });
}

}  // namespace

Section esvo_claims_section(const std::vector<EsvoSceneRuns>& scenes) {
  const auto is_faster = [](double ratio) { return ratio >= 1; };
  ClaimsTable claims;
  claims.add_range("A voxel takes few bytes more than the optimum of 5 (bytes per voxel)",
                   "5.2 to 8.1", densities(scenes), [](double bytes) { return bytes <= 8.1; });
  claims.add_range("Contours save several levels of cubes (levels saved, at least)",
                   "shown in pictures", saved_levels(scenes),
                   [](double levels) { return levels >= 2; });
  claims.add_range("Rays at contours are faster than at cubes (rate / rate)", "1.1 to 2.7",
                   speedups(scenes, EsvoForm::kContours, EsvoForm::kCubes), is_faster);
  claims.add_range("Beams make them faster (rate / rate)", "1.0 to 1.4",
                   speedups(scenes, EsvoForm::kContoursBeams, EsvoForm::kContours), is_faster);
  claims.add_range("Contours with beams are faster than triangles (rate / rate)", "1.05 to 2.1",
                   advantages_over_triangles(scenes), is_faster);
  claims.add_range(
      "The filter is one to two orders of magnitude faster than the casts (casts / "
      "filter)",
      "10 to 100", filter_advantages(scenes), [](double ratio) { return ratio >= 10; });
  Section section{"Claims", 2, {}};
  section.parts.emplace_back(Paragraph{
      "Figures are those of the paper's scenes and their variants, at the finest resolution that "
      "was measured. Ratios of speeds are those of the device named above, and those to triangles "
      "of the processor; the paper measured a GPU."});
  section.parts.emplace_back(claims.take("Claims of the paper"));
  return section;
}

}  // namespace voxdag::lab
