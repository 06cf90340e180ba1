#pragma once
/// Computes the numbers of a DAG's cells, and checks those of a file.
#include "voxdag/layout/cell_index.hpp"

namespace voxdag {

/// Numbers the cells of levels 0 to `finest_level` (0 to L) of a valid DAG. Serial; O(DAG) time and
/// no memory besides the result, which counts in no budget: see cell_index_bytes(). The result
/// depends on the voxels and the level alone.
CellIndex build_cell_index(const SvdagView& dag, int finest_level);

/// Returns the most bytes that build_cell_index() can need: 8 for each node word of the DAG.
inline std::uint64_t most_cell_index_bytes(const SvdagView& dag) {
  return 8 * (dag.node_words() + kMaxLevels);
}

/// Throws Error unless `index` holds exactly the numbers that build_cell_index() computes for this
/// valid DAG and index.finest_level. Reads `index.word_count()` words, whatever they contain.
/// O(DAG) time, no memory. The place is "level 3, word 17", a word of the DAG's nodes.
void validate_cell_index(const SvdagView& dag, const CellIndexView& index);

}  // namespace voxdag
