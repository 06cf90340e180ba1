#include <fmt/core.h>

#include <algorithm>

#include "lab/papers/svdag_published.hpp"
#include "lab/reproduce/resolution_table.hpp"
#include "lab/reproduce/svdag/svdag_sections.hpp"

namespace voxdag::lab {
namespace {

constexpr double kMebibyte = 1 << 20;

using Read = double (*)(const CellResult&);

struct Structure {
  const char* name;
  SeriesMember builds;
  Read nodes, bytes;
  published::StructureSizes published::SceneSizes::*published;  ///< Null: the paper has none.
};

/// Returns the structures that the table compares. An ESVO without contours has the nodes of the
/// SVO. A node of the SVO, which has no pointers, is one byte.
std::vector<Structure> structures() {
  return {{"DAG", &SvdagSceneBuilds::dags, dag_nodes, dag_bytes, &published::SceneSizes::dag},
          {"ESVO", &SvdagSceneBuilds::esvos, esvo_nodes, esvo_bytes, &published::SceneSizes::esvo},
          {"ESVO, shape only", &SvdagSceneBuilds::shapes, esvo_nodes, esvo_bytes, nullptr},
          {"ESVO without contours", &SvdagSceneBuilds::dags, svo_nodes,
           [](const CellResult& result) { return 8 * svo_nodes(result); }, nullptr},
          {"SVO", &SvdagSceneBuilds::dags, svo_nodes, svo_nodes, &published::SceneSizes::svo}};
}

void add_rows(ResolutionTable& nodes, ResolutionTable& memory, const SvdagSceneBuilds& builds,
              const Structure& structure) {
  const std::string title = builds.scene.title();
  const std::vector<SeriesRun>& series = builds.*structure.builds;
  if (!builds.scene.is_absent()) {
    nodes.add(title, structure.name, [&](int level) {
      return number_text(value_at(series, level, structure.nodes) * 1e-6);
    });
    memory.add(title, structure.name, [&](int level) {
      return number_text(value_at(series, level, structure.bytes) / kMebibyte);
    });
  }
  const published::SceneSizes* const sizes =
      builds.scene.shows_published() ? published::sizes_of(builds.scene.scene->name) : nullptr;
  if (sizes == nullptr || structure.published == nullptr) return;
  const published::StructureSizes& row = sizes->*structure.published;
  const std::string what = fmt::format("{}, published", structure.name);
  nodes.add(title, what,
            [&](int level) { return number_text(published::at_levels(row.million_nodes, level)); });
  memory.add(title, what,
             [&](int level) { return number_text(published::at_levels(row.megabytes, level)); });
}

/// Adds the bits per voxel at the highest resolution that was built.
void add_density(Table& table, const SvdagSceneBuilds& builds) {
  const auto highest = std::find_if(builds.dags.rbegin(), builds.dags.rend(),
                                    [](const auto& build) { return build.result.failure.empty(); });
  const published::BitsPerVoxel* const paper =
      builds.scene.shows_published() ? published::bits_of(builds.scene.scene->name) : nullptr;
  std::vector<std::string> row{builds.scene.title(), "–", "–", "–", "–", "–", "–", "–"};
  if (highest != builds.dags.rend()) {
    const nlohmann::ordered_json& json = highest->result.json;
    row[1] = short_resolution(highest->levels);
    row[2] = human_count(json.at("voxels").get<double>());
    row[3] = fmt::format("{:.2f}", json.at("bits_per_voxel").at("svdag_paper").get<double>());
    row[4] = fmt::format("{:.2f}", json.at("bits_per_voxel").at("svo_pointerless").get<double>());
  }
  if (paper != nullptr) {
    row[5] = paper->resolution;
    row[6] = fmt::format("{:.2f}", paper->dag);
    row[7] = fmt::format("{:.2f}", paper->svo);
  }
  table.rows.push_back(std::move(row));
}

}  // namespace

Section table2_section(const std::vector<SvdagSceneBuilds>& scenes) {
  const std::vector<int> levels = levels_of(scenes, &SvdagSceneBuilds::dags);
  ResolutionTable nodes("Nodes in millions", levels);
  ResolutionTable memory("Memory in MB (2^20 bytes)", levels);
  Table density{
      "Bits per voxel at the highest resolution that was built",
      {"scene", "resolution", "voxels", "DAG", "SVO", "published: resolution", "DAG", "SVO"},
      {}};
  for (const SvdagSceneBuilds& builds : scenes) {
    for (const Structure& structure : structures()) add_rows(nodes, memory, builds, structure);
    add_density(density, builds);
  }
  Section section{"Table 2: nodes and memory", 2, {}};
  section.parts.emplace_back(Paragraph{fmt::format(
      "Published: {}. As in the paper, an ESVO node counts 8 bytes (child mask, contour and "
      "pointer) without its colours and normals, and a node of the SVO, which has no pointers, one "
      "byte. The paper's ESVOs come from the program of Laine and Karras with its default "
      "settings, ours from voxdag with its own: a leaf's colours and normals must be uniform, so "
      "textures keep the octree deep. An ESVO of the shape only ends where the contours are close "
      "enough to the surface; without contours, it ends at voxels and has the nodes of the SVO. A "
      "node of our DAG has 4 bytes of child mask and 4 bytes per child; the two lowest levels are "
      "8 bytes for 4³ voxels.",
      published::kTable2Source)});
  section.parts.emplace_back(nodes.take());
  section.parts.emplace_back(memory.take());
  section.parts.emplace_back(std::move(density));
  add_commands(section, scenes, &SvdagSceneBuilds::dags);
  add_commands(section, scenes, &SvdagSceneBuilds::esvos);
  add_commands(section, scenes, &SvdagSceneBuilds::shapes);
  return section;
}

}  // namespace voxdag::lab
