#include "voxdag/file/report/dag_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "voxdag/core/printable.hpp"
#include "voxdag/file/metadata_json.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/stored/compact/compact_parts.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::ordered_json;

/// Returns a / b, or 0 if b is 0.
double quotient(double a, double b) { return b > 0 ? a / b : 0; }

double bits_per_voxel(std::uint64_t bytes, const SvdagCounts& counts) {
  return quotient(8 * static_cast<double>(bytes), static_cast<double>(counts.voxels));
}

std::string ratio_of(std::uint64_t svo, std::uint64_t dag) {
  return dag == 0 ? "" : human_ratio(static_cast<double>(svo) / static_cast<double>(dag));
}

std::string row(const std::string& name, const std::string& svo, const std::string& dag,
                const std::string& ratio) {
  std::string line = fmt::format("  {:<14}{:>20}{:>20}{:>10}", name, svo, dag, ratio);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::uint64_t whole_bytes(std::uint64_t bits) { return (bits + 7) / 8; }

Json vec_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }

double bits_per_cell(std::uint64_t bytes, const AttributeSizes& sizes) {
  return quotient(8 * static_cast<double>(bytes), static_cast<double>(sizes.cells));
}

Json attributes_json(const AttributesMetadata& metadata, const AttributeSizes& sizes) {
  Json json;
  json["index_bytes"] = sizes.index_bytes;
  const char* const form = sizes.is_wire ? "wire" : "pages";
  const auto add = [&](const char* name, std::uint64_t bytes) -> Json& {
    json[name] = {{"resolution", metadata.resolution},
                  {"cells", sizes.cells},
                  {"bytes", bytes},
                  {"bits_per_cell", bits_per_cell(bytes, sizes)}};
    return json[name];
  };
  if (metadata.colors) {
    const double psnr = metadata.color_psnr_db(sizes.cells);
    Json& color = add("color", sizes.color_bytes);
    color["form"] = form;
    color["bound"] = metadata.colors->bound;
    // The PSNR of exact colours is infinite, which JSON cannot write.
    if (metadata.colors->errors) color["psnr_db"] = std::isfinite(psnr) ? Json(psnr) : Json();
  }
  if (metadata.normals) {
    Json& normal = add("normal", sizes.normal_bytes);
    normal["form"] = form;
    normal["bound"] = metadata.normals->bound;
    if (metadata.normals->errors)
      normal["mean_degrees"] = metadata.normal_mean_degrees(sizes.cells);
  }
  if (metadata.materials) {
    Json& material = add("material", sizes.material_bytes);
    material["form"] = form;
    material["names"] = *metadata.materials;
  }
  if (!sizes.channels.empty()) json["channels"] = Json::array();
  for (const ChannelReport& channel : sizes.channels)
    json["channels"].push_back({{"name", channel.spec.name},
                                {"kind", name_of(channel.spec.kind)},
                                {"bound", channel.spec.bound},
                                {"bytes", channel.bytes},
                                {"bits_per_cell", bits_per_cell(channel.bytes, sizes)},
                                {"least", channel.range.least},
                                {"greatest", channel.range.most}});
  return json;
}

std::string color_error(const AttributesMetadata& metadata, std::uint64_t cells) {
  const auto& errors = metadata.colors->errors;
  if (!errors) return "";
  if (*errors == 0) return ", lossless";
  return fmt::format(", PSNR {:.1f} dB", metadata.color_psnr_db(cells));
}

std::string normal_error(const AttributesMetadata& metadata, std::uint64_t cells) {
  if (!metadata.normals->errors) return "";
  return fmt::format(", mean error {:.2f}°", metadata.normal_mean_degrees(cells));
}

/// Returns the first names of a list, separated by commas.
std::string first_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    text += (i == 0 ? ": " : ", ") + printable(names[i].empty() ? "(no name)" : names[i]);
  return names.size() > kMost ? text + ", ..." : text;
}

/// Returns lines that describe the attributes; an empty text if there are none. `ids` says what the
/// material ids stand for.
std::string attributes_table(const AttributesMetadata& metadata, const AttributeSizes& sizes,
                             const std::string& ids) {
  if (metadata.resolution == 0) return "";
  std::string text =
      fmt::format("\n  {:<14}{} of {}³ and coarser, index {}\n", "cells", with_commas(sizes.cells),
                  with_commas(metadata.resolution), human_bytes(sizes.index_bytes));
  const auto add = [&](const char* name, std::uint64_t bytes, const std::string& more) {
    text += fmt::format("  {:<14}{}, {:.3f} bits/cell{}{}\n", name, human_bytes(bytes),
                        bits_per_cell(bytes, sizes), sizes.is_wire ? ", wire form" : "", more);
  };
  if (metadata.colors) add("colours", sizes.color_bytes, color_error(metadata, sizes.cells));
  if (metadata.normals) add("normals", sizes.normal_bytes, normal_error(metadata, sizes.cells));
  if (metadata.materials)
    add("material ids", sizes.material_bytes,
        fmt::format(", {} {}s{}", with_commas(metadata.materials->size()), ids,
                    first_names(*metadata.materials)));
  for (const ChannelReport& channel : sizes.channels)
    text +=
        fmt::format("  {:<14}{}, {:.3f} bits/cell, {}{}, {:.6g} to {:.6g}\n", "channel",
                    channel.spec.name + ": " + human_bytes(channel.bytes),
                    bits_per_cell(channel.bytes, sizes), name_of(channel.spec.kind),
                    channel.spec.bound > 0 ? fmt::format(" within {:.6g}", channel.spec.bound) : "",
                    channel.range.least, channel.range.most);
  return text;
}

}  // namespace

AttributeSizes sizes_of(const DagAttributesView& attributes) {
  if (attributes.is_empty()) return {};
  AttributeSizes sizes{attributes.index.cells,       attributes.index.bytes(),
                       attributes.colors.bytes(),    attributes.normals.bytes(),
                       attributes.materials.bytes(), false};
  for (std::size_t i = 0; i < attributes.channels.count(); ++i) {
    const ChannelView channel = attributes.channels[i];
    sizes.channels.push_back({spec_of(channel), 8 * channel.word_count, range_of(channel)});
  }
  return sizes;
}

std::uint64_t AttributeSizes::channel_bytes() const {
  std::uint64_t bytes = 0;
  for (const ChannelReport& channel : channels) bytes += channel.bytes;
  return bytes;
}

CompactBytes bytes_of(const CompactSvdagView& compact, std::uint64_t head_bytes) {
  const CompactParts parts = compact_parts(compact);
  std::vector<std::uint64_t> shared;
  for (int level = 0; !compact.is_empty() && level <= compact.coded_levels() - 3; ++level)
    shared.push_back(compact.shared_nodes(level));
  return {head_bytes, whole_bytes(parts.node_bits), whole_bytes(parts.unit_bits),
          whole_bytes(parts.shared_brick_bits), shared};
}

Json dag_json(const DagReport& report) {
  const VdagMetadata& metadata = report.metadata;
  const SvdagCounts& counts = metadata.counts;
  const std::uint64_t svo_bytes = counts.svo_nodes();
  Json json;
  json["resolution"] = metadata.grid.resolution();
  json["levels"] = metadata.grid.levels;
  json["voxels"] = counts.voxels;
  json["svo_nodes"] = counts.svo_nodes();
  json["dag_nodes"] = counts.dag_nodes();
  json["svo_nodes_per_level"] = counts.svo_nodes_per_level;
  json["dag_nodes_per_level"] = counts.dag_nodes_per_level;
  json["bytes"] = {{"svo_pointerless", svo_bytes},
                   {"svdag_paper", report.svdag_bytes()},
                   {"svdag_nodes", report.node_bytes},
                   {"svdag_leaf_blocks", report.leaf_bytes},
                   {"file", report.file_bytes}};
  json["bits_per_voxel"] = {{"svo_pointerless", bits_per_voxel(svo_bytes, counts)},
                            {"svdag_paper", bits_per_voxel(report.svdag_bytes(), counts)},
                            {"file", bits_per_voxel(report.file_bytes, counts)}};
  if (report.compact) {
    const CompactBytes& compact = *report.compact;
    json["bytes"]["compact"] = compact.total();
    json["bytes"]["compact_parts"] = {{"head", compact.head},
                                      {"nodes", compact.nodes},
                                      {"units", compact.units},
                                      {"shared_bricks", compact.shared_bricks}};
    json["compact_shared_nodes_per_level"] = compact.shared_nodes_per_level;
    json["bits_per_voxel"]["compact"] = bits_per_voxel(compact.total(), counts);
  }
  if (metadata.attributes.resolution != 0)
    json["attributes"] = attributes_json(metadata.attributes, report.attributes);
  add_placement_json(json, metadata);
  return json;
}

void add_placement_json(Json& json, const SceneMetadata& metadata) {
  const Grid& grid = metadata.grid;
  const VdagSource& source = metadata.source;
  json["transform"] = {{"origin", vec_json(grid.origin)},
                       {"voxel_size", grid.voxel_size},
                       {"quantization_scale", grid.quantization_scale}};
  json["source"] = {
      {"name", source.name}, {"vertices", source.vertices}, {"triangles", source.triangles}};
  json["program"] = metadata.program;
  json["build"] = metadata.build;
  add_presentation(json, metadata.presentation);
}

std::string placement_table(const SceneMetadata& metadata) {
  const Grid& grid = metadata.grid;
  const VdagSource& source = metadata.source;
  const Presentation& presentation = metadata.presentation;
  std::string view;
  if (presentation.up)
    view = fmt::format("  {:<14}{}{}", "up", *presentation.up,
                       presentation.is_up_guessed ? " (guessed; --up sets it)" : "");
  if (!presentation.unit.empty()) view += ", in " + printable(presentation.unit);
  if (presentation.up && presentation.home)
    view += fmt::format(", home at ({:.6g}, {:.6g}, {:.6g})", presentation.home->eye.x,
                        presentation.home->eye.y, presentation.home->eye.z);
  if (!view.empty()) view += "\n";
  const Vec3d lo = grid.origin, hi = grid.bounds().hi;
  // An imported file has no triangles; its points or voxels count as vertices.
  const bool is_mesh = source.triangles > 0 || source.vertices == 0;
  const std::string items = is_mesh ? with_commas(source.triangles) + " triangles"
                                    : with_commas(source.vertices) + " points or voxels";
  return fmt::format(
      "  {:<14}{}, {}\n"
      "  {:<14}{}³ voxels of {:.6g}, from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n{}",
      is_mesh ? "mesh" : "source", printable(source.name), items, "grid",
      with_commas(grid.resolution()), grid.voxel_size, lo.x, lo.y, lo.z, hi.x, hi.y, hi.z, view);
}

std::string dag_table(const DagReport& report) {
  const SvdagCounts& counts = report.metadata.counts;
  const std::uint64_t svo_bytes = counts.svo_nodes();
  std::string text = placement_table(report.metadata);
  text += fmt::format("  {:<14}{}\n\n", "voxels", with_commas(counts.voxels));
  text += row("", "SVO", "DAG", "ratio");
  text += row("nodes", with_commas(counts.svo_nodes()), with_commas(counts.dag_nodes()),
              ratio_of(counts.svo_nodes(), counts.dag_nodes()));
  text += row("size", human_bytes(svo_bytes), human_bytes(report.svdag_bytes()),
              ratio_of(svo_bytes, report.svdag_bytes()));
  text += row("bits/voxel", fmt::format("{:.3f}", bits_per_voxel(svo_bytes, counts)),
              fmt::format("{:.3f}", bits_per_voxel(report.svdag_bytes(), counts)), "");
  const auto ids = report.metadata.build.find("ids");
  text +=
      attributes_table(report.metadata.attributes, report.attributes,
                       ids == report.metadata.build.end() ? "material" : printable(ids->second));
  if (!report.compact) return text;
  const CompactBytes& compact = *report.compact;
  text += '\n';
  text += row("", "plain", "compact", "part");
  const auto compact_row = [&](const char* name, std::uint64_t plain, std::uint64_t bytes) {
    text += row(name, plain == 0 ? "" : human_bytes(plain), human_bytes(bytes),
                fmt::format("{:.3f}", quotient(static_cast<double>(bytes),
                                               static_cast<double>(report.svdag_bytes()))));
  };
  compact_row("geometry", report.svdag_bytes(), compact.total());
  compact_row("nodes", 0, compact.nodes);
  compact_row("units", 0, compact.units);
  compact_row("shared bricks", 0, compact.shared_bricks);
  compact_row("head", 0, compact.head);
  const AttributeSizes& sizes = report.attributes;
  const auto attribute_row = [&](const char* name, std::uint64_t plain, std::uint64_t bytes) {
    if (plain > 0) text += row(name, human_bytes(plain), human_bytes(bytes), "");
  };
  attribute_row("cell numbers", sizes.index_bytes, 0);
  attribute_row("colours", sizes.color_bytes, sizes.color_bytes);
  attribute_row("normals", sizes.normal_bytes, sizes.normal_bytes);
  attribute_row("material ids", sizes.material_bytes, sizes.material_bytes);
  attribute_row("channels", sizes.channel_bytes(), sizes.channel_bytes());
  const std::uint64_t values =
      sizes.color_bytes + sizes.normal_bytes + sizes.material_bytes + sizes.channel_bytes();
  attribute_row("all", report.svdag_bytes() + sizes.index_bytes + values, compact.total() + values);
  text += row("bits/voxel", fmt::format("{:.3f}", bits_per_voxel(report.svdag_bytes(), counts)),
              fmt::format("{:.3f}", bits_per_voxel(compact.total(), counts)), "");
  return text;
}

std::string level_table(const SvdagCounts& counts) {
  std::string text = row("level", "SVO nodes", "DAG nodes", "ratio");
  for (std::size_t level = 0; level < counts.svo_nodes_per_level.size(); ++level) {
    const std::uint64_t svo = counts.svo_nodes_per_level[level];
    const std::uint64_t dag = counts.dag_nodes_per_level[level];
    text += row(std::to_string(level), with_commas(svo), with_commas(dag), ratio_of(svo, dag));
  }
  return text;
}

}  // namespace voxdag
