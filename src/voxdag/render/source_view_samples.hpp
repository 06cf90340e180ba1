#pragma once
/// View samples of a tile from a ViewSource instead of the voxels.
#include <algorithm>

#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

/// Sets `samples`, one for each pixel of the tile, row by row. Host only.
inline void find_source_samples(const ViewSource& source, const RenderSetup& setup,
                                const ViewTile& tile, std::span<ViewSample> samples) {
  std::fill(samples.begin(), samples.end(), ViewSample{});
  source.sample(setup.camera, tile, samples);
  // Points are exact, so rays can use cells as fine as voxels; coarser cells would be visible at
  // edges and contacts.
  for (ViewSample& sample : samples)
    if (sample.is_hit()) sample.cell_size = static_cast<float>(setup.grid.voxel_size);
}

}  // namespace voxdag
