#pragma once
/// Computes where a displaced mesh moves a point of its surface.
#include "voxdag/mesh/displace/displaced_mesh.hpp"
#include "voxdag/mesh/displace/displacement_seams.hpp"

namespace voxdag {

/// Returns the texture coordinates of `p`, in [0,1), for a texture that is projected along `axis`
/// and covers squares of `size` world units.
Vec2f projected_uv(Vec3d p, int axis, double size);

/// Returns how many texels of its heights a triangle has per world unit.
double texel_density(const DisplacedMesh& mesh, std::uint32_t triangle);
/// Returns how many texels of the heights an edge crosses per world unit.
double edge_texel_density(const DisplacedMesh& mesh, CornerIndex edge);
/// Returns the mip level whose texels are as large as the edges of micro triangles. `edge_limit` is
/// in world units.
float height_level(double texel_density, double edge_limit);

/// Returns the offset by which a triangle alone moves a point, in world units. `normal` need not
/// have unit length.
Vec3d triangle_offset(const DisplacedMesh& mesh, std::uint32_t triangle, Vec3d position,
                      Vec3f normal, Vec2f uv, float level);
/// Returns the offset of a group of coinciding corners: the mean over its members.
Vec3d corner_offset(const DisplacedMesh& mesh, const DisplacementSeams::Group& group,
                    Vec3d position, double edge_limit);
/// Returns the offset of a point on a group of coinciding edges: the mean over its members. `along`
/// is 0 at the first of the edges' ends and 1 at the last.
Vec3d edge_offset(const DisplacedMesh& mesh, const DisplacementSeams& seams,
                  const DisplacementSeams::Group& group, Vec3d position, float along,
                  double edge_limit);

}  // namespace voxdag
