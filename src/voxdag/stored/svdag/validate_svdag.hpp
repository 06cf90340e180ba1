#pragma once
/// Validation of a DAG from an untrusted source against the layout in svdag.hpp or long_svdag.hpp.
///
/// Each check throws Error("", place, reason) at the first fault; the place is "level 3, word 17"
/// (index in SvdagView::nodes), "leaf block 5" or "level table". Serial.
#include "voxdag/stored/svdag/long_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Checks that any code can walk the view without further checks. The level table must increase
/// from 0, and level 0 must be one node, the root. Every node must have a child, no mask bits that
/// the layout leaves zero, and end inside of its level. Every pointer must lead to the first word
/// of a node of the next level, which excludes cycles. No leaf block may be zero. A view without
/// words and blocks is valid. `nodes` and `leaf_blocks` must have as many elements as the view
/// says. O(DAG) time: two passes over the words and one random bit read per pointer; one bit of
/// memory per word of the largest level.
void validate_svdag(const SvdagView& dag);
void validate_svdag(const LongSvdagView& dag);

/// Checks the canonical order, and that every node can be reached from the root. The view must be
/// valid. O(DAG) time in one pass, no memory.
void check_canonical(const SvdagView& dag);
void check_canonical(const LongSvdagView& dag);

/// Checks that no two nodes of a level are equal. The view must be valid. Expected O(DAG) time; 8
/// to 16 bytes of memory per node of the largest level, 16 to 32 with long pointers.
void check_minimal(const SvdagView& dag);
void check_minimal(const LongSvdagView& dag);

}  // namespace voxdag
