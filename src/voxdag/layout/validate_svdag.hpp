#pragma once
/// Whether the words of a DAG are what svdag.hpp says, for data that comes from outside.
///
/// Each check throws Error("", place, reason) at the first fault; place is "level 3, word 17"
/// (index in SvdagView::nodes), "leaf block 5" or "level table". Serial.
#include "voxdag/layout/svdag.hpp"

namespace voxdag {

/// Safety: a view that passes can be walked by any code without a check. The level table increases
/// from 0; level 0 is one node, the root; every node has a child, no mask bits above the
/// eighth, and ends inside its level; every pointer is the first word of a node of the next level
/// (so there are no cycles); no leaf block is zero. A view without words and blocks is valid.
/// `nodes` and `leaf_blocks` must have as many elements as the view says.
/// O(DAG) time, two passes over the words and one random bit read per pointer; one bit of memory
/// per word of the largest level.
void validate_svdag(const SvdagView& dag);

/// Canonical order, and that every node can be reached from the root. The view must be valid.
/// O(DAG) time in one pass, no memory.
void check_canonical(const SvdagView& dag);

/// No two nodes of a level are equal. The view must be valid. Expected O(DAG) time; 8 to 16 bytes
/// of memory per node of the largest level.
void check_minimal(const SvdagView& dag);

}  // namespace voxdag
