#pragma once
/// A source of attributes: DAGs that were moved, turned and cut to a common grid.
#include <optional>
#include <vector>

#include "voxdag/algebra/attributes/derived_values.hpp"
#include "voxdag/algebra/attributes/equal_nodes.hpp"
#include "voxdag/algebra/attributes/number_finder.hpp"
#include "voxdag/core/orientation.hpp"

namespace voxdag {

/// A DAG with attributes, and where the result has its voxels: voxel p of the result is voxel
/// source_cell(orientation, p - offset, L) of the layer.
struct AttributeLayer {
  ColoredDagView colored;  ///< Valid, with voxels and attributes.
  Orientation orientation{};
  Vec3i offset{};
  std::vector<std::uint16_t> material_ids{};  ///< The new id of each; empty: ids stay.
};

/// The values of new voxels: those that lie in no layer.
struct NewValues {
  std::optional<Value8> color;            ///< Empty: the colour of the nearest voxel.
  std::optional<std::uint16_t> material;  ///< Empty: the material of the nearest voxel.
};

/// The source of placed_attributes(), for derive_attributes().
class PlacedSource {
 public:
  static constexpr std::size_t kMaxLayers = 2;

  /// Refers to the layers. See placed_attributes().
  PlacedSource(const SvdagView& dag, int finest_level, std::span<const AttributeLayer> layers,
               const NewValues& new_values, const ValueKinds& kinds, MemoryBudget* memory);

  struct LayerCell {
    enum State : std::uint8_t {
      kUnknown,  ///< The cell is not one cell of the layer, or was not looked up.
      kAbsent,   ///< The layer has no cell here.
      kInStep,   ///< `cell` is the layer's cell, or that of its finest level around it.
    };
    State state = kAbsent;
    NumberedCell cell{};
  };
  using Cell = std::array<LayerCell, kMaxLayers>;

  class Reader {
   public:
    explicit Reader(const PlacedSource& source);
    CellValues values(const Cell& at, Vec3i voxel);

   private:
    struct Layer {
      NumberFinder finder;
      StoredReader stored;
      bool is_here = false;
      CellValues here, nearest;  ///< Turned.
      bool has_nearest = false;
    };
    CellValues read(std::size_t layer, std::uint64_t number);
    const CellValues& nearest(std::size_t layer, Vec3i voxel);
    template <class Has>
    const CellValues* find(const Has& has, bool is_given, Vec3i voxel);

    const PlacedSource& source_;
    std::vector<Layer> layers_;
  };

  Cell root() const;
  Cell child(const Cell& above, const NumberedCell& cell, Vec3i place) const;
  std::optional<StoredRun> run(const Cell& at, const NumberedCell& cell) const;
  Reader reader() const { return Reader(*this); }
  std::size_t stored_count() const { return layers_.size(); }
  StoredValues stored(std::size_t i) const {
    return {layers_[i].colored.attributes, layers_[i].material_ids};
  }
  const ValueKinds& kinds() const { return kinds_; }

 private:
  LayerCell find_cell(const AttributeLayer& layer, int level, Vec3i place) const;

  SvdagView dag_;
  int finest_;
  std::span<const AttributeLayer> layers_;
  NewValues new_values_;
  ValueKinds kinds_;
  NodeClasses classes_;  ///< Of the result's nodes.
  std::vector<NodeClasses> layer_classes_;
  std::vector<bool> has_runs_;  ///< Whether values of the layer can be copied for whole subtrees.
};

}  // namespace voxdag
