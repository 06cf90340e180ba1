#pragma once
/// Reads the colours, normals, materials and channels of many voxels, one after the other.
#include <span>
#include <vector>

#include "voxdag/core/orientation.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"

namespace voxdag {

/// The colour, the normal and the material of a voxel, in the types of exported files.
struct VoxelLook {
  Vec3f normal{};                          ///< World space, unit length; zero: none.
  Value8 color{};                          ///< sRGB encoded; black: none.
  std::uint16_t material = kMaxMaterials;  ///< kMaxMaterials: none.
};

/// Reads what look_at() and material_at() read, faster if the voxels come in Morton order. Each
/// thread needs its own. Refers to the bytes of the look.
class LookReader {
 public:
  /// With `orientation`, the cells to read are those of the reoriented grid, and so are normals.
  explicit LookReader(const LookView& look, const Orientation& orientation = {})
      : look_(look),
        orientation_(orientation),
        is_turned_(!(orientation == Orientation{})),
        colors_(look.dag.attributes.colors),
        normals_(look.dag.attributes.normals),
        has_colors_(look.has_colors()),
        has_normals_(look.has_normals()),
        has_materials_(look.has_materials()) {
    for (std::size_t i = 0; i < look.dag.attributes.channels.count(); ++i)
      channels_.push_back(look.dag.attributes.channels[i]);
  }

  bool has_colors() const { return has_colors_; }
  bool has_normals() const { return has_normals_; }
  bool has_materials() const { return has_materials_; }
  const std::vector<ChannelView>& channels() const { return channels_; }
  /// Returns whether there are neither colours nor normals nor materials.
  bool is_empty() const { return !has_colors_ && !has_normals_ && !has_materials_; }

  /// Returns what is stored for the cell `cell` of `level`.
  VoxelLook read(Vec3i cell, int level) {
    if (!is_turned_) return read_stored(cell, level);
    VoxelLook result = read_stored(source_cell(orientation_, cell, level), level);
    const Vec3f normal = result.normal;
    for (int axis = 0; axis < 3; ++axis)
      result.normal[axis] =
          normal[orientation_.source_axis[axis]] * (orientation_.is_flipped[axis] ? -1.0f : 1.0f);
    return result;
  }

  /// Sets `values`, one for each of channels(), to those that are stored for the cell; 0 if it is
  /// not in the look.
  void read_channels(Vec3i cell, int level, std::span<double> values) const {
    if (is_turned_) cell = source_cell(orientation_, cell, level);
    std::uint64_t number = 0;
    const bool is_stored = find_number(look_.dag, cell, level, number);
    for (std::size_t i = 0; i < channels_.size(); ++i)
      values[i] = is_stored ? channels_[i].read(number) : 0;
  }

 private:
  VoxelLook read_stored(Vec3i cell, int level) {
    VoxelLook result;
    if (!look_.esvo.is_empty()) {
      EsvoVoxel voxel;
      if (!find_esvo_voxel(look_.esvo, cell, level, voxel)) return result;
      if (has_normals_) stored_normal(look_.esvo, voxel, result.normal);
      if (has_colors_) stored_srgb8(look_.esvo, voxel, result.color);
      return result;
    }
    if (!look_.dag.overlays.is_empty()) return read_edited(cell, level);
    std::uint64_t number = 0;
    if (!find_number(look_.dag, cell, level, number)) return result;
    if (has_normals_) result.normal = unpack_normal(normals_.value(number));
    if (has_colors_) result.color = colors_.value(number);
    if (has_materials_)
      result.material =
          static_cast<std::uint16_t>(read_material(look_.dag.attributes.materials, number));
    return result;
  }

  VoxelLook read_edited(Vec3i cell, int level) {
    VoxelLook result;
    const ValueOverlays& overlays = look_.dag.overlays;
    if (has_normals_)
      if (const auto found = find_value(look_.dag, overlays.normals, cell, level); found.exists())
        result.normal = unpack_normal(value(normals_, found));
    if (has_colors_)
      if (const auto found = find_value(look_.dag, overlays.colors, cell, level); found.exists())
        result.color = value(colors_, found);
    if (has_materials_)
      result.material = static_cast<std::uint16_t>(material_at(look_.dag, cell, level));
    return result;
  }
  static Value8 value(PageReader& reader, const CellValue& found) {
    return found.overlay != kStoredValue ? value_of_overlay(found.overlay)
                                         : reader.value(found.number);
  }

  LookView look_;
  Orientation orientation_;
  bool is_turned_;
  PageReader colors_, normals_;
  bool has_colors_, has_normals_, has_materials_;
  std::vector<ChannelView> channels_;
};

}  // namespace voxdag
