#pragma once
/// Area-weighted sums over the surface in a voxel: the stored colour and normal are their means.
///
/// A voxel has one normal, even if it holds both sides of something thin or a crumpled surface.
/// Rule: if the normals agree well enough, so that their mean is at least half as long as they are,
/// the voxel stores the mean's direction. Otherwise it stores the axis along which the normals lie
/// (the principal axis of their outer products); the side with the larger area decides the sign. If
/// both sides have equal areas, the normal points up: z, then y, then x is positive. So the side
/// does not depend on the order of the triangles or on a sliver.
#include <cmath>

#include "voxdag/builders/pieces/piece_sampler.hpp"
#include "voxdag/builders/pieces/principal_axis.hpp"
#include "voxdag/builders/pieces/voxel_value.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

struct SurfaceSum {
  Vec3f color{};         ///< Linear light times area.
  Vec3f normal{};        ///< Normals times area; two opposite sides cancel.
  float area = 0;        ///< Visible area, in voxels² of the finest level.
  float length = 0;      ///< Lengths of the normals times area.
  OuterProductSum axes;  ///< Outer products of the normals, divided by their lengths, times area.
  float metallic = 0, roughness = 0;  ///< Times area.

  /// Adds surface of one colour and one mean normal, which may be shorter than 1.
  void add(Vec3f surface_color, Vec3f surface_normal, float surface_area,
           MetallicRoughness numbers = {}) {
    color = color + surface_color * surface_area;
    metallic += numbers.metallic * surface_area;
    roughness += numbers.roughness * surface_area;
    const Vec3f n = surface_normal * surface_area;
    normal = normal + n;
    area += surface_area;
    const float n_length = std::sqrt(dot(n, n));
    length += n_length;
    if (n_length > 0) axes.add(n, 1 / n_length);
  }

  void add(const SurfaceSum& other) {
    color = color + other.color;
    normal = normal + other.normal;
    area += other.area;
    length += other.length;
    axes.add(other.axes);
    metallic += other.metallic;
    roughness += other.roughness;
  }

  /// Returns a vector in the direction of the stored normal, by this rule: the sum of the normals,
  /// or the axis scaled to the sum of their lengths. Returns zero if no surface has a normal.
  Vec3f direction() const;
};

/// Returns the means as a voxel stores them. A voxel without a normal gets (0, 1, 0).
VoxelValue voxel_value(const SurfaceSum& sum);

/// Adds a piece of the cell to the sum. `sample` is the piece's mean appearance.
void add_piece(SurfaceSum& sum, const Cell& cell, const TrianglePiece& piece,
               const SurfaceSample& sample);

/// Sums the colours and normals of all pieces in the cell.
SurfaceSum sum_pieces(const Cell& cell, const PieceSampler& sampler);

}  // namespace voxdag
