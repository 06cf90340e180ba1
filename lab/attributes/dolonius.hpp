#pragma once
/// The size of colors in blocks of variable length.
///
/// Dan Dolonius, Erik Sintorn, Viktor Kämpe and Ulf Assarsson: Compressing Color Data for Voxelized
/// Surface Geometry, I3D 2017, with the choices of the authors' public program.
///
///   macro block  | number of its first block | bit of its first weight |    64 bits each
///   block        | first color (14 bits) | bits of a weight - 1 (2) | first weight (16) |
///                | end point 5:6:5 | end point 5:6:5 |  or  | color 10:12:10 |
///   weights      0 to 4 bits for each color
///
/// Colors are in depth-first order of the cells. A macro block has 16,384 colors. Its blocks are
/// found for weights of 0 bits first, from one block a color, then for one bit more from the blocks
/// before. In each pass every second block merges with the neighbor that gives the better score
/// (color_line.hpp), if no color of both gets an error above the threshold, until no blocks merge.
/// The blocks of 4 bits and the blocks of which they were made form trees; the cut of the trees
/// that takes the fewest bits is stored.
///
/// The error is the Euclidean distance in sRGB, channels in [0,1]. The authors' program uses a
/// threshold of 0.05; which thresholds the paper's tables use could not be settled. For colors of
/// textures the bytes here are those of the program to two parts in ten thousand, since only the
/// order of sums of floats differs.
#include <cstdint>
#include <span>
#include <vector>

#include "lab/attributes/color_line.hpp"
#include "lab/runs/size_in_parts.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// The threshold of the authors' program.
inline constexpr float kDoloniusThreshold = 0.05f;

struct EncodedColors {
  SizeInParts size;
  std::vector<ColorBytes> colors;  ///< As decoded; as many as were encoded.
};

/// Encodes colors in depth-first order and decodes them again. Runs on the current TBB arena; the
/// result does not depend on the number of threads. Throws Cancelled.
EncodedColors encode_dolonius(std::span<const ColorBytes> colors, float error_threshold,
                              const Progress& progress);

}  // namespace voxdag::lab
