#pragma once
/// The size of a DAG as a TSVDAG.
///
/// Mathijs Molenaar and Elmar Eisemann: Transform-Aware Sparse Voxel Directed Acyclic Graphs, I3D
/// 2025, with the choices of the authors' program: symmetries, permutations of axes, moves of nodes
/// of at most 16³ voxels, pointer tables and Huffman codes.
///
///   node     | 8 tags of 2 bits | pointer | ... |                  16-bit words
///   tag      words of the pointer: 0 (no child) to 3
///   leaf     | 4³ voxels |                                          64 bits
///
///   encoded  | code of the type (low bits) | move on each moved axis | place of the child |
///   type     permutation, mirrors and the set of moved axes; a move has height + 1 bits, where
///            2^height is the side of the child
///   pointer  one word: number of an entry of the table; more words: one bit, then the encoded
///            pointer (0) or the number of an entry (1)
///   table    | encoded pointer | ... |                              64 bits each, a table a level
///
/// Nodes lie level by level, ordered by the number of pointers to them; places are as in an SSVDAG
/// (ssvdag.hpp). The code of a level is optimal for the numbers of different pointers of each type;
/// its words have at most 16 bits, and types that do not occur have words too. A pointer enters the
/// table, most frequent pointers first, if the entry and its numbers take fewer words than the
/// pointers in place.
///
/// The authors' program counts neither the lengths of code words nor the starts of tables and
/// levels, and neither does this. It leaves the order of equally frequent nodes and pointers open;
/// here they keep the order of the DAG.
#include "lab/compact/transform_dag.hpp"
#include "lab/runs/size_in_parts.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag::lab {

/// Nodes of at most 2^4 voxels a side are moved, as in the authors' program.
inline constexpr int kTsvdagMoveHeight = 4;

/// Returns the size of a merged DAG. Throws Error if a pointer needs more than 64 bits.
SizeInParts tsvdag_size(const TransformDag& dag);

/// Merges and encodes a DAG. Throws Error and Cancelled.
SizeInParts tsvdag_size(const SvdagView& dag, int move_height, const Progress& progress);

}  // namespace voxdag::lab
