#pragma once
/// A model in which edits of a DAG without voxels begin.
#include "voxdag/file/model/dag_model.hpp"

namespace voxdag {

/// Returns a model with two voxels, in opposite corners of the grid of `empty`, and with the kinds
/// of values that its metadata names. A DAG without voxels has no cells, so it cannot say which
/// values its voxels would have. For EditableDag with EditOptions::starts_empty. Throws OverMemory.
DagModel seeded(const DagModel& empty, Work work = {});

}  // namespace voxdag
