#pragma once
/// The light that is baked into the colours of a cell.
#include <optional>

#include "voxdag/builders/esvo/build/surface_light.hpp"
#include "voxdag/builders/pieces/piece_sampler.hpp"

namespace voxdag {

/// Returns the mean of `light` over the pieces of a cell; there must be at least one. Returns
/// nothing if the cell is larger than a voxel and the light in it varies by more than `color_error`
/// (sRGB encoded).
std::optional<float> baked_light(const SurfaceLight& light, const Cell& cell,
                                 const PieceSampler& sampler, float color_error);

}  // namespace voxdag
