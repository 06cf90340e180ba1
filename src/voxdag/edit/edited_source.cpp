#include "voxdag/edit/edited_source.hpp"

namespace voxdag {

EditedSource::Cell EditedSource::root() const {
  Cell cell;
  cell.node = root_;
  cell.is_in_base = !nodes_.base().is_empty();
  cell.color = overlays_.colors.root;
  cell.normal = overlays_.normals.root;
  cell.material = overlays_.materials.root;
  return cell;
}

EditedSource::Cell EditedSource::child(const Cell& above, const NumberedCell& cell,
                                       Vec3i place) const {
  const int index = child_index(place, 0), leaf_level = nodes_.levels() - 2;
  Cell child = above;
  if (cell.level <= leaf_level)
    child.node = nodes_.child(above.node, index);
  else if (cell.level == leaf_level + 1)
    child.node = static_cast<std::uint32_t>(nodes_.block(above.node) >> (8 * index) & 0xFF);
  child.color = values_.child(above.color, index);
  child.normal = values_.child(above.normal, index);
  child.material = values_.child(above.material, index);
  if (!above.is_in_base || cell.level > attributes_.index.finest_level) return child;
  child.is_in_base = (children_of(nodes_.base(), above.base) >> index & 1) != 0;
  if (child.is_in_base) child.base = child_of(nodes_.base(), attributes_.index, above.base, index);
  return child;
}

std::optional<StoredRun> EditedSource::run(const Cell& at, const NumberedCell& cell) const {
  const bool is_stored = at.is_in_base && at.color == kStoredValue && at.normal == kStoredValue &&
                         at.material == kStoredValue;
  if (!is_stored) return std::nullopt;
  const bool is_equal =
      cell.level >= attributes_.index.finest_level ||
      at.node == (cell.level == nodes_.levels() - 1 ? at.base.octant : at.base.at);
  if (!is_equal) return std::nullopt;
  return StoredRun{0, at.base.number};
}

}  // namespace voxdag
