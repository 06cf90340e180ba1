#pragma once
/// Edits as JSON: one object a line, in world units.
///
///   {"op": "remove", "shape": "ball", "center": [1, 2, 3], "radius": 0.5}
///   {"op": "add", "voxels": [[1, 2, 3], [1, 2, 4]], "color": "#ff8000"}
///   {"op": "add", "voxels": "voxels.npy"}
///   {"op": "stamp", "file": "tree.vdag", "at": [4, 0, 2], "turn": ["y", 1], "mirror": "x",
///    "mode": "replace"}
///   {"op": "stamp", "file": "statue.obj", "solid": true}
///
/// The verbs, shapes and parameters are those of edit_step.hpp.
#include <string_view>

#include "edit/stamp_files.hpp"
#include "voxdag/edit/editable_dag.hpp"

namespace voxdag::cli {

/// Changes the DAG by the edit of a line. `grid` is that of the DAG. Throws Error, which names no
/// file, and what edits throw.
void apply_json_edit(std::string_view line, EditableDag& dag, const Grid& grid, StampFiles& stamps,
                     Work work);

}  // namespace voxdag::cli
