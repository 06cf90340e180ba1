#pragma once
/// The colours and normals of voxels, from an ESVO or from the attributes of a DAG.
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/esvo/stored_values.hpp"

namespace voxdag {

/// Sets `found` to the finest voxel of level 1 to `level` that holds the cell `cell` of `level`.
/// The octree's grid may have more or fewer levels. Returns false if there is no such voxel.
VOXDAG_HD inline bool find_esvo_voxel(const EsvoView& esvo, Vec3i cell, int level,
                                      EsvoVoxel& found) {
  if (esvo.is_empty()) return false;
  std::uint64_t slot = esvo.root;
  for (int depth = 1; depth <= level; ++depth) {
    const ChildDescriptor descriptor = esvo.descriptor(slot);
    const int child = child_index(cell, level - depth);
    if ((descriptor.valid_mask() >> child & 1u) == 0) return depth > 1;
    found = {slot, child};
    if ((descriptor.leaf_mask() >> child & 1u) != 0) return true;
    slot = esvo.child(slot, descriptor, child);
  }
  return level > 0;
}

/// The colour and the normal of a voxel, as far as they are stored.
struct StoredLook {
  bool has_color = false, has_normal = false;
  Vec3f color{};   ///< sRGB encoded, in [0,1].
  Vec3f normal{};  ///< World space, unit length.
  MetallicRoughness metallic_roughness;
};

/// A view for kernels and readers: of an ESVO, of a DAG with attributes, or of nothing (default).
struct LookView {
  EsvoView esvo;
  ColoredDagView dag;

  LookView() = default;
  LookView(const EsvoView& of) : esvo(of) {}       // NOLINT(google-explicit-constructor)
  LookView(const ColoredDagView& of) : dag(of) {}  // NOLINT(google-explicit-constructor)

  VOXDAG_HD bool is_empty() const { return esvo.is_empty() && dag.is_empty(); }
  VOXDAG_HD bool has_colors() const {
    return has_stored(esvo, EsvoAttachmentKind::kColors) || dag.attributes.has_colors();
  }
  VOXDAG_HD bool has_normals() const {
    return has_stored(esvo, EsvoAttachmentKind::kNormals) || dag.attributes.has_normals();
  }
  VOXDAG_HD bool has_materials() const { return dag.attributes.has_materials(); }
};

/// Sets a cell and its level to those of the cell of the finest level with attributes around it, if
/// the level is finer. The grid of the cell may have more levels than the DAG.
VOXDAG_HD inline void clamp_to_finest(const ColoredDagView& colored, Vec3i& cell, int& level) {
  const int finer = level - colored.attributes.index.finest_level;
  if (finer <= 0) return;
  cell = {cell.x >> finer, cell.y >> finer, cell.z >> finer};
  level -= finer;
}

/// Sets `number` to the number of a cell of `level`, or of its ancestor of the finest level with
/// attributes if `level` is finer. The grid of the cell may have more or fewer levels than that of
/// the DAG. Returns false if the DAG has no attributes there.
VOXDAG_HD inline bool find_number(const ColoredDagView& colored, Vec3i cell, int level,
                                  std::uint64_t& number) {
  clamp_to_finest(colored, cell, level);
  return !colored.is_empty() &&
         find_cell_number(colored.dag, colored.attributes.index, cell, level, number);
}

/// The place of a value of a cell: a number in the stored values, or a value of the overlay.
struct CellValue {
  std::uint64_t number = 0;
  bool is_stored = false;                ///< Whether `number` is set.
  std::uint32_t overlay = kStoredValue;  ///< A value that replaces the stored one.

  VOXDAG_HD bool exists() const { return is_stored || overlay != kStoredValue; }
};

/// Returns where a value of the cell of find_number() is. `overlay` is one of colored.overlays.
VOXDAG_HD inline CellValue find_value(const ColoredDagView& colored,
                                      const ValueOverlayView& overlay, Vec3i cell, int level) {
  CellValue found;
  clamp_to_finest(colored, cell, level);
  if ((cell.x | cell.y | cell.z) >> level != 0) return found;
  const std::uint32_t reference = overlay_at(overlay, cell, level);
  if (reference >= kOverlayValue) {
    found.overlay = reference;
    return found;
  }
  found.is_stored = find_number(colored, cell, level, found.number);
  if (!found.is_stored) found.overlay = first_in_overlay(overlay, reference);
  return found;
}

/// Returns the material of the cell of find_number(); kMaxMaterials if there is none. `colored`
/// must have materials.
VOXDAG_HD inline std::uint32_t material_at(const ColoredDagView& colored, Vec3i cell, int level) {
  const CellValue found = find_value(colored, colored.overlays.materials, cell, level);
  if (found.overlay != kStoredValue) return material_of_overlay(found.overlay);
  return found.is_stored ? read_material(colored.attributes.materials, found.number)
                         : kMaxMaterials;
}

/// Returns the colour, the normal, and the numbers of ColoredDagView::metallic_roughness that a
/// DAG stores for the cell of find_number().
VOXDAG_HD inline StoredLook look_at(const ColoredDagView& colored, Vec3i cell, int level) {
  StoredLook look;
  const DagAttributesView& attributes = colored.attributes;
  CellValue color, normal;
  if (colored.overlays.is_empty()) {
    color.is_stored = find_number(colored, cell, level, color.number);
    normal = color;
  } else {
    if (attributes.has_colors()) color = find_value(colored, colored.overlays.colors, cell, level);
    if (attributes.has_normals())
      normal = find_value(colored, colored.overlays.normals, cell, level);
  }
  look.has_color = attributes.has_colors() && color.exists();
  if (look.has_color) {
    const Value8 value = color.overlay != kStoredValue
                             ? value_of_overlay(color.overlay)
                             : read_value(attributes.colors, color.number);
    for (int c = 0; c < 3; ++c) look.color[c] = static_cast<float>(value[c]) / 255;
  }
  look.has_normal = attributes.has_normals() && normal.exists();
  if (look.has_normal)
    look.normal = unpack_normal(normal.overlay != kStoredValue
                                    ? value_of_overlay(normal.overlay)
                                    : read_value(attributes.normals, normal.number));
  if (!colored.metallic_roughness.is_empty()) {
    std::uint64_t number = color.number;
    if (colored.overlays.is_empty() ? color.is_stored : find_number(colored, cell, level, number))
      look.metallic_roughness = colored.metallic_roughness.read(number);
  }
  return look;
}

/// Returns what `look` stores for a cell of `level`.
VOXDAG_HD inline StoredLook look_at(const LookView& look, Vec3i cell, int level) {
  if (look.esvo.is_empty()) return look_at(look.dag, cell, level);
  StoredLook stored;
  EsvoVoxel voxel;
  if (!find_esvo_voxel(look.esvo, cell, level, voxel)) return stored;
  stored.has_color = stored_srgb(look.esvo, voxel, stored.color);
  stored.has_normal = stored_normal(look.esvo, voxel, stored.normal);
  return stored;
}

}  // namespace voxdag
