#pragma once
/// The size of colours in the blocks of an ESVO.
///
/// Samuli Laine and Tero Karras: Efficient Sparse Voxel Octrees, I3D 2010, section 3.5. A block of
/// 64 bits holds the colours of the children of two consecutive descriptors, which are siblings
/// (stored/esvo/color_block.hpp). The colour of the root is not stored.
#include <vector>

#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/stored/attributes/cell_index.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag::lab {

struct EsvoColors {
  std::uint64_t blocks = 0;    ///< Number of blocks of 8 bytes.
  std::vector<Value8> colors;  ///< Decoded colours, by number. The root keeps its exact colour.
};

/// Encodes the colours of all cells that `index` numbers and decodes them again. `colors` has one
/// for each. An ESVO may end at coarse cells that its contours and colours describe well enough;
/// these blocks always hold all cells down to the finest level. Throws Cancelled.
EsvoColors encode_esvo_colors(const SvdagView& dag, const CellIndexView& index,
                              const std::vector<Value8>& colors, const Progress& progress);

}  // namespace voxdag::lab
