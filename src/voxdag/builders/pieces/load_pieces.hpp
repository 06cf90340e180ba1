#pragma once
/// Loads the triangles of a cell for building.
#include <cstdint>
#include <span>

#include "voxdag/builders/pieces/piece_sampler.hpp"
#include "voxdag/builders/pieces/piece_stack.hpp"
#include "voxdag/builders/pieces/triangle_source.hpp"

namespace voxdag {

/// Starts a cell with those of `triangles` that meet it. `cell` is in cells of `level`. Displaced
/// triangles are tessellated to the size of a voxel.
void load_pieces(PieceStack& pieces, const PieceSampler& sampler, const TriangleSource& source,
                 int level, Vec3i cell, std::span<const std::uint32_t> triangles);

}  // namespace voxdag
