#pragma once
/// An edit as bytes for the page: the new words, and the roots.
///
/// All numbers are unsigned, of 32 bits, in the order of bytes of this machine, which must be
/// little-endian:
///
///   writer                            the number of the page that may edit
///   root, colors, normals, materials  the roots of the version to show: EditSnapshot's
///   undos, redos                      strokes that can be undone and redone
///   words, blocks, values             numbers of runs of each kind
///   (first, count) for each run       runs of words, then of blocks, then of words of values
///   the words, the blocks, the words of values   of all runs; a block has its lower half first
///
/// Undo and redo write nothing, so their updates have no runs.
#include <cstdint>
#include <string>
#include <vector>

#include "voxdag/edit/editable_dag.hpp"

namespace voxdag {

struct EditUpdate {
  static constexpr int kHeadWords = 10;

  std::uint32_t writer = 0, root = 0, colors = 0, normals = 0, materials = 0, undos = 0, redos = 0;
  EditChanges nodes;
  std::vector<EditRun> values;

  /// Returns the bytes, with the contents of the runs.
  std::string bytes(const EditNodes& from, const EditValues& of_values) const;
};

}  // namespace voxdag
