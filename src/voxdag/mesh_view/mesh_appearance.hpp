#pragma once
/// The colours and normals at points of a mesh's triangles: those of its file, or else a grey
/// surface with smooth normals.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "voxdag/mesh_view/packed_normal.hpp"
#include "voxdag/surface/surface_shading.hpp"

namespace voxdag {

struct MeshViewOptions {
  Vec3f albedo{0.62f, 0.60f, 0.57f};  ///< Linear, in [0,1], of surfaces without a colour.
  /// If a mesh has no normals, edges whose faces differ by less are smoothed (see corner_normals).
  float crease_degrees = 40;
};

/// Immutable and thread-safe. Points of triangles are given by the barycentric coordinates of
/// corners 1 and 2.
class MeshAppearance {
 public:
  /// For a mesh without an appearance. Reads the mesh only during this call.
  MeshAppearance(const Mesh& mesh, const MeshViewOptions& options);
  /// `mesh` must outlive this object. Decodes the textures; those that cannot be read are ignored,
  /// with a warning (see SurfaceShading). Throws Cancelled.
  MeshAppearance(const Mesh& mesh, Appearance appearance, const MeshViewOptions& options,
                 std::vector<std::string>* warnings, Progress* progress);
  // Not copyable: the shading points to the appearance.
  MeshAppearance(const MeshAppearance&) = delete;
  MeshAppearance& operator=(const MeshAppearance&) = delete;

  /// Returns the mean colour, linear, in [0,1], over a convex polygon in the triangle.
  Vec3f albedo(std::uint32_t triangle, std::span<const Vec2f> footprint) const;
  /// Returns the normal at a point or, from a texture, its mean over the polygon around the point.
  /// It has any length and points to either side of the surface; it is zero if there is none.
  Vec3f normal(std::uint32_t triangle, Vec2f point, std::span<const Vec2f> footprint) const;

  /// Return whether there may be alpha-masked parts, and whether a point is in one.
  bool has_holes() const { return has_holes_; }
  bool is_hole(std::uint32_t triangle, Vec2f point) const;

 private:
  Vec3f albedo_;
  std::optional<Appearance> appearance_;
  std::optional<SurfaceShading> shading_;
  bool has_colors_ = false, has_holes_ = false;
  std::vector<std::array<PackedNormal, 3>> smooth_normals_;  // empty if all corners have their own
};

}  // namespace voxdag
