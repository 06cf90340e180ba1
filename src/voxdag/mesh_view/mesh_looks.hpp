#pragma once
/// What the points of a mesh's triangles look like: as its file says, and grey and round where it
/// says nothing.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "voxdag/mesh_view/packed_normal.hpp"
#include "voxdag/surface/surface_shading.hpp"

namespace voxdag {

struct MeshViewOptions {
  Vec3f albedo{0.62f, 0.60f, 0.57f};  ///< Linear, in [0,1], of what has no colour.
  /// Where a mesh has no normals, edges whose faces differ by less look round (see corner_normals).
  float crease_degrees = 40;
};

/// Immutable and thread-safe. Points of triangles are given by the barycentric coordinates of
/// corners 1 and 2.
class MeshLooks {
 public:
  /// Of a mesh of which nothing is known. The mesh is read here alone.
  MeshLooks(const Mesh& mesh, const MeshViewOptions& options);
  /// `mesh` must outlive it. Decodes the textures; what cannot be read is named in `warnings` and
  /// left out (see SurfaceShading). Throws Cancelled.
  MeshLooks(const Mesh& mesh, Appearance appearance, const MeshViewOptions& options,
            std::vector<std::string>* warnings, Progress* progress);
  // The shading points to the appearance.
  MeshLooks(const MeshLooks&) = delete;
  MeshLooks& operator=(const MeshLooks&) = delete;

  /// The mean colour, linear, in [0,1], over a convex polygon in the triangle.
  Vec3f albedo(std::uint32_t triangle, std::span<const Vec2f> footprint) const;
  /// The normal at a point or, where a texture has it, its mean over the polygon around it: of any
  /// length, on any side of the surface; zero where there is none.
  Vec3f normal(std::uint32_t triangle, Vec2f point, std::span<const Vec2f> footprint) const;

  /// Whether alpha may have cut something away; whether it has at a point.
  bool has_holes() const { return has_holes_; }
  bool is_hole(std::uint32_t triangle, Vec2f point) const;

 private:
  Vec3f albedo_;
  std::optional<Appearance> appearance_;
  std::optional<SurfaceShading> shading_;
  bool has_colors_ = false, has_holes_ = false;
  std::vector<std::array<PackedNormal, 3>> smooth_normals_;  // empty where all have their own
};

}  // namespace voxdag
