#pragma once
/// Models that were made from other models.
#include <span>
#include <string>
#include <utility>

#include "voxdag/algebra/attributes/placed_attributes.hpp"
#include "voxdag/file/model/dag_model.hpp"

namespace voxdag {

/// Returns a model of `dag` in `grid`, without attributes and home view. The metadata are `source`;
/// their entry "edits" gets `edit`, which says how the voxels were made. Throws OverMemory.
DagModel edited(const VdagMetadata& source, Svdag dag, const Grid& grid, const std::string& edit,
                Work work = {});
inline DagModel edited(const DagModel& source, Svdag dag, const Grid& grid, const std::string& edit,
                       Work work = {}) {
  return edited(source.metadata(), std::move(dag), grid, edit, work);
}

/// A model whose voxels an edit keeps, and where they are in its result: see AttributeLayer.
struct PlacedModel {
  const DagModel& model;
  Orientation orientation{};
  Vec3i offset{};
};

/// Choices about the attributes of an edited DAG.
struct EditedValues {
  NewValues new_values{};
  CoarsenBounds bounds{};  ///< Within these, values may change when they are encoded again.
};

/// Returns a model of `dag` in `grid` as edited() does, with the attributes that
/// placed_attributes() gives its voxels. `models` are one or two; the metadata are those of the
/// first. Materials of the second that the first has by name get its ids, the others follow. The
/// errors of stored values are not known. Throws Error if a given new value has no kind or no
/// material in the models, if the metadata of a model do not describe its attributes, or if the
/// result would have more than kMaxMaterials materials; OverMemory and Cancelled.
DagModel edited(std::span<const PlacedModel> models, Svdag dag, const Grid& grid,
                const std::string& edit, const EditedValues& values = {}, Work work = {});

}  // namespace voxdag
