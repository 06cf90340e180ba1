#include "voxdag/file/vdag_metadata.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "voxdag/file/metadata_json.hpp"

namespace voxdag {
namespace {

MetadataJson values_json(const AttributesMetadata::Values& values) {
  MetadataJson json = {{"bound", values.bound}};
  if (values.errors) json["errors"] = *values.errors;
  return json;
}

MetadataJson attributes_json(const AttributesMetadata& attributes) {
  MetadataJson json;
  json["resolution"] = attributes.resolution;
  if (attributes.colors) json["color"] = values_json(*attributes.colors);
  if (attributes.normals) json["normal"] = values_json(*attributes.normals);
  if (attributes.materials) json["material"] = {{"names", *attributes.materials}};
  if (!attributes.labels.empty()) json["material"]["labels"] = attributes.labels;
  return json;
}

AttributesMetadata read_attributes(const MetadataField& field, const Grid& grid) {
  AttributesMetadata attributes;
  const std::uint64_t resolution = field.at("resolution").count();
  if (!std::has_single_bit(resolution) ||
      resolution > static_cast<std::uint64_t>(grid.resolution()))
    field.at("resolution").fail("not a power of two up to the grid's resolution");
  attributes.resolution = static_cast<std::int64_t>(resolution);
  const auto read = [&](const char* name, std::optional<AttributesMetadata::Values>& values) {
    if (!field.value.contains(name)) return;
    const MetadataField of = field.at(name);
    values = {of.at("bound").finite(), {}};
    if (of.value.contains("errors")) values->errors = of.at("errors").count();
  };
  read("color", attributes.colors);
  read("normal", attributes.normals);
  if (field.value.contains("material")) {
    const MetadataField names = field.at("material").at("names");
    if (!names.value.is_array()) names.fail("not an array");
    attributes.materials.emplace();
    for (std::size_t i = 0; i < names.value.size(); ++i)
      attributes.materials->push_back(names.at(i).text());
    if (field.at("material").value.contains("labels")) {
      const MetadataField labels = field.at("material").at("labels");
      labels.expect_array(names.value.size());
      for (std::size_t i = 0; i < names.value.size(); ++i)
        attributes.labels.push_back(labels.at(i).integer());
    }
  }
  return attributes;
}

}  // namespace

double AttributesMetadata::color_psnr_db(std::uint64_t cells) const {
  if (!colors || colors->errors.value_or(0) == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255 * 3 * static_cast<double>(cells) /
                         static_cast<double>(*colors->errors));
}

double AttributesMetadata::normal_mean_degrees(std::uint64_t cells) const {
  if (!normals || cells == 0) return 0;
  const double distance =
      static_cast<double>(normals->errors.value_or(0)) / 256 / static_cast<double>(cells);
  return distance / 127 * 180 / std::numbers::pi;
}

std::optional<std::size_t> find_material(const AttributesMetadata& attributes,
                                         std::string_view wanted) {
  if (!attributes.materials) return std::nullopt;
  const auto place_of = [](const auto& list, const auto& value) -> std::optional<std::size_t> {
    const auto at = std::find(list.begin(), list.end(), value);
    if (at == list.end()) return std::nullopt;
    return static_cast<std::size_t>(at - list.begin());
  };
  if (const auto id = place_of(*attributes.materials, wanted)) return id;
  std::int64_t number = 0;
  const char* const end = wanted.data() + wanted.size();
  const auto [read, error] = std::from_chars(wanted.data(), end, number);
  if (error != std::errc{} || read != end) return std::nullopt;
  if (!attributes.labels.empty()) return place_of(attributes.labels, number);
  if (number < 0 || std::cmp_greater_equal(number, attributes.materials->size()))
    return std::nullopt;
  return static_cast<std::size_t>(number);
}

std::string vdag_metadata_json(const VdagMetadata& metadata) {
  MetadataJson json = begin_metadata_json(metadata);
  json["counts"] = {{"voxels", metadata.counts.voxels},
                    {"svo_nodes_per_level", metadata.counts.svo_nodes_per_level},
                    {"dag_nodes_per_level", metadata.counts.dag_nodes_per_level}};
  if (metadata.attributes.resolution != 0)
    json["attributes"] = attributes_json(metadata.attributes);
  finish_metadata_json(json, metadata);
  return metadata_text(json);
}

VdagMetadata parse_vdag_metadata(std::string_view text) {
  const MetadataJson json = parse_metadata_json(text);
  const MetadataField root{json, ""};
  VdagMetadata metadata;
  read_scene_metadata(root, metadata);
  const auto levels = static_cast<std::size_t>(metadata.grid.levels);
  const MetadataField counts = root.at("counts");
  metadata.counts.voxels = counts.at("voxels").count();
  metadata.counts.svo_nodes_per_level = counts.at("svo_nodes_per_level").counts(levels);
  metadata.counts.dag_nodes_per_level = counts.at("dag_nodes_per_level").counts(levels);
  if (json.is_object() && json.contains("attributes"))
    metadata.attributes = read_attributes(root.at("attributes"), metadata.grid);
  return metadata;
}

VdagMetadata coarser_metadata(VdagMetadata metadata, const SvdagView& dag) {
  const double factor = static_cast<double>(std::int64_t{1} << (metadata.grid.levels - dag.levels));
  metadata.grid.levels = dag.levels;
  metadata.grid.voxel_size *= factor;
  metadata.grid.quantization_scale /= factor;
  metadata.counts = count_svdag(dag);
  metadata.build["coarsened_from"] =
      std::to_string(metadata.grid.resolution() * static_cast<std::int64_t>(factor));
  return metadata;
}

void describe_coarser(AttributesMetadata& attributes, int levels, const CoarsenBounds& bounds) {
  if (attributes.level() <= levels) return;
  attributes.resolution = std::int64_t{1} << levels;
  const auto encode_again = [](std::optional<AttributesMetadata::Values>& values, double bound,
                               double most) {
    if (values) values = {std::min(values->bound + bound, most), {}};
  };
  encode_again(attributes.colors, bounds.color_bound, 1.0);
  encode_again(attributes.normals, bounds.normal_bound_degrees, 180.0);
}

}  // namespace voxdag
