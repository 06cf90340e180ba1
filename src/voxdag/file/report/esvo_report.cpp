#include "voxdag/file/report/esvo_report.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "voxdag/file/report/dag_report.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::uint64_t> of_levels(const EsvoCounts::PerLevel& counts, int levels) {
  return {counts.begin(), counts.begin() + levels + 1};
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

EsvoReport report_of(const EsvoContents& contents, std::uint64_t file_bytes) {
  return {contents.metadata, esvo_bytes(contents.view, contents.directory), file_bytes};
}

Json esvo_json(const EsvoReport& report) {
  const EsvoMetadata& metadata = report.metadata;
  const EsvoCounts& counts = metadata.counts;
  const EsvoBytes& bytes = report.bytes;
  Json json;
  json["kind"] = "esvo";
  json["resolution"] = metadata.grid.resolution();
  json["levels"] = metadata.grid.levels;
  json["voxels"] = counts.voxels();
  json["leaves"] = counts.leaves();
  json["bytes_per_voxel"] = report.bytes_per_voxel();
  json["voxels_per_level"] = of_levels(counts.voxels_per_level, metadata.grid.levels);
  json["leaves_per_level"] = of_levels(counts.leaves_per_level, metadata.grid.levels);
  json["descriptors"] = counts.descriptors;
  json["far_pointers"] = counts.far_pointers;
  json["contours"] = counts.contours;
  json["blocks"] = counts.blocks;
  json["bytes"] = {{"descriptors", bytes.descriptors},
                   {"far_pointers", bytes.far_pointers},
                   {"gaps", bytes.gaps},
                   {"info", bytes.info},
                   {"contours", bytes.contours},
                   {"colors", bytes.colors},
                   {"normals", bytes.normals},
                   {"padding", bytes.padding},
                   {"esvo", bytes.total()},
                   {"file", report.file_bytes}};
  add_placement_json(json, metadata);
  return json;
}

std::string esvo_table(const EsvoReport& report) {
  const EsvoCounts& counts = report.metadata.counts;
  const EsvoBytes& bytes = report.bytes;
  std::string text = placement_table(report.metadata);
  text += fmt::format("  {:<14}{}, of them {} leaves\n", "voxels", with_commas(counts.voxels()),
                      with_commas(counts.leaves()));
  text +=
      fmt::format("  {:<14}{}, one for {:.1f} voxels\n", "contours", with_commas(counts.contours),
                  counts.contours == 0 ? 0.0 : 1 / share(counts.contours, counts.voxels()));
  text += fmt::format("  {:<14}{}, {} far pointers for {} descriptors\n\n", "blocks",
                      with_commas(counts.blocks), with_commas(counts.far_pointers),
                      with_commas(counts.descriptors));
  text += fmt::format("  {:<14}{:>14}{:>16}\n", "", "size", "bytes/voxel");
  const auto row = [&](const char* name, std::uint64_t size) {
    text += fmt::format("  {:<14}{:>14}{:>16.2f}\n", name, human_bytes(size),
                        share(size, counts.voxels()));
  };
  row("descriptors", bytes.descriptors);
  row("far pointers", bytes.far_pointers);
  row("gaps", bytes.gaps);
  row("contours", bytes.contours);
  row("colours", bytes.colors);
  row("normals", bytes.normals);
  row("padding", bytes.info + bytes.padding);
  row("all", bytes.total());
  return text;
}

std::string esvo_level_table(const EsvoReport& report) {
  const EsvoCounts& counts = report.metadata.counts;
  std::string text = fmt::format("  {:<14}{:>20}{:>20}\n", "level", "voxels", "leaves");
  for (std::size_t level = 0; level <= static_cast<std::size_t>(report.metadata.grid.levels);
       ++level)
    text +=
        fmt::format("  {:<14}{:>20}{:>20}\n", level, with_commas(counts.voxels_per_level[level]),
                    with_commas(counts.leaves_per_level[level]));
  return text;
}

}  // namespace voxdag
