#pragma once
/// The colours and normals at points of a mesh's triangles. They come from its file, or else the
/// surface is grey with smooth normals.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"
#include "voxdag/mesh_view/packed_normal.hpp"

namespace voxdag {

struct MeshViewOptions {
  Vec3f albedo{0.62f, 0.60f, 0.57f};  ///< Linear, in [0,1], of surfaces without a colour.
  /// If a mesh has no normals, edges between faces with a smaller angle are smoothed (see
  /// corner_normals).
  float crease_degrees = 40;
};

/// Immutable and thread-safe. Points of triangles are given by the barycentric coordinates of
/// corners 1 and 2.
class MeshAppearance {
 public:
  /// Makes the appearance of a mesh that has none in its file. Reads the mesh only during this
  /// call.
  MeshAppearance(const Mesh& mesh, const MeshViewOptions& options);
  /// `mesh` must outlive this object. Decodes the textures; those that cannot be read are ignored,
  /// with a warning (see SurfaceShading). Throws Cancelled.
  MeshAppearance(const Mesh& mesh, Appearance appearance, const MeshViewOptions& options,
                 std::vector<std::string>* warnings, Work work);
  // Not copyable: the shading points to the appearance.
  MeshAppearance(const MeshAppearance&) = delete;
  MeshAppearance& operator=(const MeshAppearance&) = delete;

  /// Returns the mean colour over a convex polygon in the triangle: linear light, in [0,1].
  Vec3f albedo(std::uint32_t triangle, std::span<const Vec2f> footprint) const;
  /// Returns the normal at a point. If it comes from a texture, returns its mean over the polygon
  /// around the point. It may have any length and point to either side; it is zero if there is no
  /// normal.
  Vec3f normal(std::uint32_t triangle, Vec2f point, std::span<const Vec2f> footprint) const;

  /// Returns whether there may be alpha-masked parts.
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
