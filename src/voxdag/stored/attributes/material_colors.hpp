#pragma once
/// Shows material ids as colours.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/material_ids.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// Returns the colour that stands for a material, sRGB encoded. Materials with near ids have
/// clearly different colours.
Value8 material_color(std::uint32_t id);

/// Returns the colours of all cells. Runs on the current TBB arena. Throws Cancelled.
ValuePages material_colors(const MaterialIdsView& ids, Work work = {});

}  // namespace voxdag
