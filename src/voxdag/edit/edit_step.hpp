#pragma once
/// One edit as a value, made from names and numbers in world units: of a line of a script, of JSON
/// or of a message.
///
///   shape     | numbers
///   ----------|------------------------------------------------------------------
///   ball      | center 3, radius 1
///   box       | min 3, max 3
///   capsule   | from 3, to 3, radius 1
///   halfspace | point 3, normal 3: the side that the normal points away from
///   turnedbox | center 3, half 3, turn 4: half sides, and a quaternion x,y,z,w
///
/// add, remove, paint and replace take any shape; smooth, grow and shrink take a ball. copy and
/// move take no shape, but min 3, max 3, to 3: a box, and the place of its lower corner. undo and
/// redo take none.
#include <cstdint>
#include <span>
#include <string_view>

#include "voxdag/core/box.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/edit/editable_dag.hpp"

namespace voxdag {

enum class EditVerb {
  kAdd,
  kRemove,
  kPaint,
  kReplace,
  kSmooth,
  kGrow,
  kShrink,
  kCopy,
  kMove,
  kUndo,
  kRedo
};

struct EditStep {
  EditVerb verb = EditVerb::kUndo;
  EditShape shape{};  ///< Of kAdd to kShrink; a BallShape for filters.
  EditPaint paint{};  ///< Of kAdd, kPaint and kReplace.
  Box3i box{};        ///< Of kCopy and kMove, in voxels; without box.hi.
  Vec3i to{};         ///< Where the voxel box.lo comes, in voxels.
};

/// A parameter of an edit, and how many numbers it has.
struct EditField {
  std::string_view name;
  std::size_t count;
};

/// Returns the verb "add", "remove" and so on. Throws Error for another name.
EditVerb edit_verb(std::string_view name);
/// Returns the name of a verb.
std::string_view verb_name(EditVerb verb);
/// Returns whether the verb changes the voxels of a shape.
inline bool takes_shape(EditVerb verb) { return verb <= EditVerb::kShrink; }
/// Returns the parameters of an edit, in their order. `shape` is empty for verbs without a shape.
/// Throws Error if there is no such shape or the verb does not take it.
std::span<const EditField> edit_fields(EditVerb verb, std::string_view shape);

/// Makes an edit. `numbers` are the numbers of edit_fields(), one after another. The box of copy
/// and move has the voxels whose centres lie in it, and moves by whole voxels: `to - min` is
/// rounded. Throws Error for names, numbers and paint that the edit does not take.
EditStep make_edit_step(EditVerb verb, std::string_view shape, std::span<const double> numbers,
                        const EditPaint& paint, const Grid& grid);

/// Changes the DAG. Throws what the edits of EditableDag throw, and Error if there is nothing to
/// undo or to redo.
void apply_step(EditableDag& dag, const EditStep& step);

/// Returns the colour of a text "\#rrggbb". Throws Error.
Value8 edit_color(std::string_view text);

}  // namespace voxdag
