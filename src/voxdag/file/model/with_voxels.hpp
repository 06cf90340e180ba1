#pragma once
/// A model with the voxels of an edit.
#include <optional>
#include <string>
#include <utility>

#include "voxdag/file/model/edited.hpp"

namespace voxdag {

/// Returns a model of `dag` and its attributes, which may be empty, in the grid of `source`. The
/// attributes have the levels and the materials of those of `source`. The metadata is that of
/// `source`; its entry "edits" gets `edit`. Without voxels, it keeps the kinds of values unless
/// `drops_values`. Throws OverMemory.
inline DagModel with_voxels(const DagModel& source, Svdag dag, DagAttributes attributes,
                            const std::string& edit, Work work = {}, bool drops_values = false) {
  Svdag none;
  none.levels = dag.levels;
  VdagMetadata metadata = edited(source, std::move(none), source.grid(), edit).metadata();
  if (dag.view().is_empty() ? !drops_values : !attributes.view().is_empty()) {
    metadata.attributes = source.metadata().attributes;
    for (auto* values : {&metadata.attributes.colors, &metadata.attributes.normals})
      if (*values) (*values)->errors.reset();
  }
  return {std::move(dag), std::move(attributes), std::move(metadata), work};
}

}  // namespace voxdag
