#pragma once
/// Shows channels as colours.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// The colours of the map, sRGB encoded, from the least value to the greatest at equal distances:
/// those of viridis (Smith, van der Walt, Firing, matplotlib 2015; CC0).
inline constexpr Value8 kColorMap[] = {{68, 1, 84},    {71, 45, 123},  {59, 82, 139},
                                       {44, 114, 142}, {33, 145, 140}, {40, 174, 128},
                                       {94, 201, 98},  {173, 220, 48}, {253, 231, 37}};

/// Returns the colour of a place in the map, 0 to 1: colours between those of kColorMap are
/// mixed. Clamps other places.
Value8 mapped_color(double place);

/// Returns the colours of all cells: range.least has the first colour, range.most the last one.
/// Runs on the current TBB arena. Throws Cancelled.
ValuePages channel_colors(const ChannelView& channel, const ChannelRange& range, Work work = {});

}  // namespace voxdag
