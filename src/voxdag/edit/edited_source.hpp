#pragma once
/// A source of attributes: a version of an edited DAG, for derive_attributes().
#include <optional>

#include "voxdag/algebra/attributes/derived_values.hpp"
#include "voxdag/edit/edit_nodes.hpp"
#include "voxdag/edit/edit_values.hpp"

namespace voxdag {

/// Walks the nodes of a version, those of its base and its overlays in step. A subtree has the
/// stored values if it has the base's node, at the base's place, and nothing in the overlays.
class EditedSource {
 public:
  /// Refers to all arguments. `root` is the version's root, `overlays` have its overlays' roots.
  EditedSource(const EditNodes& nodes, const EditValues& values, std::uint32_t root,
               const ValueOverlays& overlays, const DagAttributesView& attributes)
      : nodes_(nodes),
        values_(values),
        root_(root),
        overlays_(overlays),
        attributes_(attributes),
        kinds_(kinds_of(attributes)) {}

  struct Cell {
    std::uint32_t node = EditNodes::kNone;  ///< Of the version; at level L-1, the octant's voxels.
    bool is_in_base = false;
    NumberedCell base{};  ///< The base's cell, or that of level m around it.
    std::uint32_t color = kStoredValue, normal = kStoredValue, material = kStoredValue;
  };

  class Reader {
   public:
    explicit Reader(const EditedSource& source) : stored_(source.stored(0)) {}
    CellValues values(const Cell& at, Vec3i) {
      CellValues values{kNoColor, kNoNormal, 0};
      if (at.is_in_base) values = stored_.values(at.base.number);
      if (at.color >= kOverlayValue) values.color = value_of_overlay(at.color);
      if (at.normal >= kOverlayValue) values.normal = value_of_overlay(at.normal);
      if (at.material >= kOverlayValue)
        values.material = static_cast<std::uint16_t>(material_of_overlay(at.material));
      return values;
    }

   private:
    StoredReader stored_;
  };

  Cell root() const;
  Cell child(const Cell& above, const NumberedCell& cell, Vec3i place) const;
  std::optional<StoredRun> run(const Cell& at, const NumberedCell& cell) const;
  Reader reader() const { return Reader(*this); }
  std::size_t stored_count() const { return 1; }
  StoredValues stored(std::size_t) const { return {attributes_, {}}; }
  const ValueKinds& kinds() const { return kinds_; }

 private:
  /// Values of voxels that no edit gave any: there are none.
  static constexpr Value8 kNoColor{128, 128, 128}, kNoNormal{128, 255, 128};

  const EditNodes& nodes_;
  const EditValues& values_;
  std::uint32_t root_;
  ValueOverlays overlays_;
  DagAttributesView attributes_;
  ValueKinds kinds_;
};

}  // namespace voxdag
