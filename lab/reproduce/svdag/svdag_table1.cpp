#include <fmt/core.h>

#include "lab/papers/svdag_published.hpp"
#include "lab/reproduce/resolution_table.hpp"
#include "lab/reproduce/svdag/svdag_sections.hpp"

namespace voxdag::lab {
namespace {

double wall_seconds(const CellResult& result) { return result.cost.wall_seconds; }

/// Returns a function that reads a stage of `build --json`.
auto stage(const char* name) {
  return [name](const CellResult& result) { return stage_seconds(result, name); };
}

/// Adds rows of measured seconds.
template <class Read>
void add_seconds(ResolutionTable& table, const SvdagSceneBuilds& builds, const char* what,
                 SeriesMember series, const Read& read) {
  if (builds.scene.is_absent()) return;
  table.add(builds.scene.title(), what,
            [&](int level) { return seconds_text(value_at(builds.*series, level, read)); });
}

void add_published(ResolutionTable& table, const SvdagSceneBuilds& builds) {
  if (!builds.scene.shows_published()) return;
  for (const bool is_sorting : {false, true})
    table.add(builds.scene.title(),
              is_sorting ? "published, of it sorting" : "published, reduction", [&](int level) {
                const auto paper = published::reduction_at(builds.scene.scene->name, level);
                if (!paper) return seconds_text(NAN);
                return seconds_text(is_sorting ? paper->sorting : paper->total);
              });
}

}  // namespace

Section table1_section(const std::vector<SvdagSceneBuilds>& scenes, int threads) {
  const std::vector<int> levels = levels_of(scenes, &SvdagSceneBuilds::by_paper);
  ResolutionTable reduction(
      fmt::format(
          "Wall-clock time to reduce the octree to the DAG. Ours: {} threads. Published: {}",
          threads, published::kSource),
      levels);
  ResolutionTable whole("Wall-clock time of whole builds, from the start of the process to its end",
                        levels);
  for (const SvdagSceneBuilds& builds : scenes) {
    add_seconds(reduction, builds, "reduction", &SvdagSceneBuilds::by_paper, stage("reduce"));
    add_seconds(reduction, builds, "of it sorting", &SvdagSceneBuilds::by_paper, stage("sort"));
    add_published(reduction, builds);
    add_seconds(whole, builds, "the paper's method", &SvdagSceneBuilds::by_paper, wall_seconds);
    add_seconds(whole, builds, "voxdag's method", &SvdagSceneBuilds::by_hash, wall_seconds);
  }
  Section section{"Table 1: time of the reduction", 2, {}};
  section.parts.emplace_back(Paragraph{
      "The paper reduces sub-volumes of 1024³ one after the other, sorts each level with "
      "tbb::parallel_sort on six cores, and does the rest on one core. --method paper does the "
      "same in the same order. Its reduction includes joining the sub-volumes under the top tree "
      "and the final reduction of the whole. The paper's algorithm also reduces trees whose leaves "
      "have different depths. voxdag's never do: a mesh has voxels at the finest level only."});
  section.parts.emplace_back(reduction.take());
  add_commands(section, scenes, &SvdagSceneBuilds::by_paper);
  section.parts.emplace_back(Paragraph{
      "voxdag's own method never makes the octree, so its time to reduce one cannot be stated. "
      "Whole builds compare the two methods."});
  section.parts.emplace_back(whole.take());
  add_commands(section, scenes, &SvdagSceneBuilds::by_hash);
  return section;
}

}  // namespace voxdag::lab
