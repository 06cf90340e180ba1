#pragma once
/// The colours, normals, materials and channels of a DAG's cells.
#include "voxdag/stored/attributes/cell_index_lookup.hpp"
#include "voxdag/stored/attributes/channels.hpp"
#include "voxdag/stored/attributes/material_ids.hpp"
#include "voxdag/stored/attributes/metallic_roughness_channels.hpp"
#include "voxdag/stored/attributes/value_overlay.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// A view for kernels and readers. The value of a cell has the cell's number.
struct DagAttributesView {
  CellIndexView index;
  ValuePagesView colors;      ///< sRGB encoded; empty: none.
  ValuePagesView normals;     ///< See unpack_normal(); empty: none.
  MaterialIdsView materials;  ///< Empty: none.
  ChannelsView channels{};    ///< Empty: none. Kernels do not read them.

  VOXDAG_HD bool has_colors() const { return !colors.is_empty(); }
  VOXDAG_HD bool has_normals() const { return !normals.is_empty(); }
  VOXDAG_HD bool has_materials() const { return !materials.is_empty(); }
  VOXDAG_HD bool has_channels() const { return !channels.is_empty(); }
  VOXDAG_HD bool is_empty() const {
    return !has_colors() && !has_normals() && !has_materials() && !has_channels();
  }
};

/// A DAG with the attributes of its cells. If the DAG is being edited, `dag` is the DAG to which
/// the attributes belong, and `overlays` have the values that edits gave to its cells and to new
/// ones.
struct ColoredDagView {
  SvdagView dag;
  DagAttributesView attributes;
  ValueOverlays overlays{};
  /// Two of the channels, for kernels. Renderers set it; DeviceAttributes refers to its copies.
  MetallicRoughnessView metallic_roughness{};

  VOXDAG_HD bool is_empty() const { return dag.is_empty() || attributes.is_empty(); }
};

/// Rounds a unit normal to a value: 128 stands for 0, 1 for -1 and 255 for 1.
inline Value8 pack_normal(Vec3f normal) {
  Value8 value{};
  for (int c = 0; c < 3; ++c)
    value[c] = static_cast<std::uint8_t>(static_cast<int>(127 * normal[c] + 128.5f));
  return value;
}

/// Returns the normal of a value, in unit length; (0, 1, 0) for the value (128, 128, 128).
VOXDAG_HD inline Vec3f unpack_normal(Value8 value) {
  const Vec3f v{static_cast<float>(value.x - 128), static_cast<float>(value.y - 128),
                static_cast<float>(value.z - 128)};
  return normalized_or(v, Vec3f{0, 1, 0});
}

}  // namespace voxdag
