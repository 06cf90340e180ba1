#pragma once
/// The size of a DAG as an SSVDAG.
///
/// Alberto Jaspe Villanueva, Fabio Marton and Enrico Gobbetti: SSVDAGs: Symmetry-aware Sparse Voxel
/// DAGs, I3D 2016, and Symmetry-aware Sparse Voxel DAGs (SSVDAGs) for compression-domain tracing of
/// high-resolution geometric scenes, Journal of Computer Graphics Techniques 6(2), 2017.
///
///   node      | 8 tags of 2 bits | pointer | ... |            16-bit words
///   tag       0: no child; 1: pointer of one word; 2 or 3: of two words, the tag has bit 29 of it
///   pointer   | place of the child (13 or 29 bits and one in the tag) | mirrors (3 bits) |
///   leaf      | 4³ voxels |                                    64 bits
///
/// Nodes lie level by level, and each level is ordered by the number of pointers to its nodes. The
/// place of an inner node is its first word, counted from the start of its level; the place of a
/// leaf is its number. A table has the start of each level.
///
/// The papers leave open how nodes with equally many pointers are ordered; sizes depend on it by
/// about a thousandth. Here they keep the order of the DAG. The authors' program does not see that
/// a node is its own mirror image if its children are, and takes up to 6% more (lab/README.md).
#include "lab/compact/merged_dag.hpp"
#include "lab/runs/size_in_parts.hpp"

namespace voxdag::lab {

/// Returns the size of a DAG that was merged by mirrors. Throws Error if a level is too large for
/// 30-bit places.
SizeInParts ssvdag_size(const MergedDag& dag);

/// Merges by the mirrors that the authors' program finds. Throws Error and Cancelled.
SizeInParts ssvdag_size(const SvdagView& dag, const Progress& progress);

}  // namespace voxdag::lab
