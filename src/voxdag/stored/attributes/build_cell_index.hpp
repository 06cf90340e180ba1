#pragma once
/// Computes the numbers of a DAG's cells, and checks those of a file.
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/stored/attributes/cell_index.hpp"

namespace voxdag {

/// Numbers the cells of levels 0 to `finest_level`, 0 to L, of a valid DAG. The result depends on
/// the voxels and the level alone. Serial; time in O(DAG). Counts its memory in `memory`, at most
/// twice that of the result, until it returns. Throws OverMemory.
CellIndex build_cell_index(const SvdagView& dag, int finest_level, MemoryBudget* memory = nullptr);

/// Throws Error unless `index` holds exactly the numbers that build_cell_index() computes for this
/// valid DAG and index.finest_level. Reads `index.word_count()` words, whatever they contain. Time
/// in O(DAG), no memory. The place of an error is "level 3, word 17", a word of the DAG's nodes.
void validate_cell_index(const SvdagView& dag, const CellIndexView& index);

}  // namespace voxdag
