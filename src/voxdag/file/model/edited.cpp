#include "voxdag/file/model/edited.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/file/verify_vdag.hpp"

namespace voxdag {
namespace {

VdagMetadata edited_metadata(const VdagMetadata& source, const Grid& grid,
                             const std::string& edit) {
  VdagMetadata metadata = source;
  metadata.grid = grid;
  metadata.attributes = {};
  metadata.presentation.home.reset();
  std::string& edits = metadata.build["edits"];
  edits += (edits.empty() ? "" : "; ") + edit;
  return metadata;
}

/// Adds the names that `all` does not have. Returns the places of all of them. Names may repeat:
/// each place is taken once.
std::vector<std::uint16_t> merge_names(std::vector<std::string>& all,
                                       const std::vector<std::string>& names) {
  std::multimap<std::string, std::size_t> known;
  for (std::size_t i = 0; i < all.size(); ++i) known.emplace(all[i], i);
  std::vector<std::uint16_t> ids;
  for (const std::string& name : names) {
    const auto found = known.lower_bound(name);
    if (found != known.end() && found->first == name) {
      ids.push_back(static_cast<std::uint16_t>(found->second));
      known.erase(found);
      continue;
    }
    if (all.size() == kMaxMaterials)
      throw Error("the result would have more than " + std::to_string(kMaxMaterials) +
                  " materials");
    ids.push_back(static_cast<std::uint16_t>(all.size()));
    all.push_back(name);
  }
  return ids;
}

/// Describes values that were encoded again: their bounds add up.
void join_bound(std::optional<AttributesMetadata::Values>& values, double stored, double again,
                double most) {
  const double bound = std::min(stored + again, most);
  values = {std::max(values ? values->bound : 0, bound), {}};
}

void check_given(const NewValues& given, const AttributesMetadata& attributes) {
  if (given.color && !attributes.colors) throw Error("a colour of new voxels needs colours");
  if (!given.material) return;
  const std::size_t count = attributes.materials ? attributes.materials->size() : 0;
  if (*given.material >= count)
    throw Error("new voxels cannot have material " + std::to_string(*given.material) + ": there " +
                (count == 0 ? "are no materials" : "are " + std::to_string(count) + ", from 0"));
}

}  // namespace

DagModel edited(const VdagMetadata& source, Svdag dag, const Grid& grid, const std::string& edit,
                Work work) {
  return {std::move(dag), {}, edited_metadata(source, grid, edit), work};
}

DagModel edited(std::span<const PlacedModel> models, Svdag dag, const Grid& grid,
                const std::string& edit, const EditedValues& values, Work work) {
  VdagMetadata metadata = edited_metadata(models[0].model.metadata(), grid, edit);
  AttributesMetadata& joined = metadata.attributes;
  std::vector<AttributeLayer> layers;
  for (const PlacedModel& placed : models) {
    const DagAttributesView attributes = placed.model.attributes();
    if (attributes.is_empty()) continue;
    AttributeLayer& layer = layers.emplace_back(
        AttributeLayer{{placed.model.view(), attributes}, placed.orientation, placed.offset, {}});
    const AttributesMetadata& of = placed.model.metadata().attributes;
    compare_attributes(of, attributes);
    if (of.colors) join_bound(joined.colors, of.colors->bound, values.bounds.color_bound, 1);
    if (of.normals)
      join_bound(joined.normals, of.normals->bound, values.bounds.normal_bound_degrees, 180);
    if (!of.materials) continue;
    if (!joined.materials) joined.materials.emplace();
    const std::size_t before = joined.materials->size();
    const bool have_labels = !of.labels.empty() && joined.labels.size() == before;
    layer.material_ids = merge_names(*joined.materials, *of.materials);
    joined.labels.resize(have_labels ? joined.materials->size() : 0);
    for (std::size_t i = 0; have_labels && i < of.labels.size(); ++i)
      if (layer.material_ids[i] >= before) joined.labels[layer.material_ids[i]] = of.labels[i];
  }
  check_given(values.new_values, joined);
  DagAttributes attributes =
      placed_attributes(dag.view(), layers, values.new_values,
                        joined.materials ? static_cast<std::uint32_t>(joined.materials->size()) : 0,
                        values.bounds, work);
  if (attributes.view().is_empty())
    joined = {};
  else
    joined.resolution = std::int64_t{1} << attributes.index.finest_level;
  return {std::move(dag), std::move(attributes), std::move(metadata), work};
}

}  // namespace voxdag
