#pragma once
/// Colour, coverage and normal of pieces of a mesh's surface: what a voxel is painted with.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct SurfaceSample {
  Vec3f color;         ///< Mean colour of the visible part, linear light.
  float coverage = 1;  ///< Visible part of the area, 0..1.
  Vec3f normal;  ///< Mean of the unit normals: its length says how much they agree. Zero for a
                 ///< triangle without area or normals.
};

/// Refers to mesh and appearance, which must outlive it; owns the decoded textures. Immutable and
/// thread-safe. Polygons are convex, lie in their triangle, and are given by the barycentric
/// coordinates (of corners 1 and 2) of their corners; one, two or collinear corners are fine, and
/// none where the triangle has one colour and one normal.
class SurfaceShading {
 public:
  /// Decodes the textures. What cannot be read is left out and named in `warnings`, one line each
  /// with what stands in for it. `memory`, if not null, counts the textures and must outlive this.
  /// Throws Cancelled and OverMemory.
  SurfaceShading(const Mesh& mesh, const Appearance& appearance,
                 std::vector<std::string>* warnings = nullptr, Progress* progress = nullptr,
                 MemoryBudget* memory = nullptr);
  ~SurfaceShading();
  SurfaceShading(SurfaceShading&&) noexcept;

  /// Means over a polygon. Textures are read through mip maps with a footprint of the polygon's
  /// size and shape.
  SurfaceSample mean(std::uint32_t triangle, std::span<const Vec2f> polygon) const;

  bool has_normal_map(std::uint32_t triangle) const;
  /// Whether all of the triangle is visible and of one colour; whether all its normals are one.
  bool has_one_color(std::uint32_t triangle) const;
  bool has_one_normal(std::uint32_t triangle) const;

  /// True only if all of the polygon is visible (or, where `mean.coverage` is 0, none of it), the
  /// colour of every point is within `color_error` of the mean's (largest difference of a channel,
  /// both encoded as sRGB in 0..1) and its normal within `normal_error` radians of the mean's
  /// direction. May be false all the same.
  bool is_uniform(std::uint32_t triangle, std::span<const Vec2f> polygon, float color_error,
                  float normal_error, const SurfaceSample& mean) const;

  /// False only if is_uniform is false with these errors, whatever the mean: a look at the bounds
  /// of the textures, much faster than mean() and is_uniform().
  bool may_be_uniform(std::uint32_t triangle, std::span<const Vec2f> polygon, float color_error,
                      float normal_error) const;

  /// True only if no point of the polygon passes the alpha test. May be false all the same.
  bool is_alpha_masked(std::uint32_t triangle, std::span<const Vec2f> polygon) const;

  /// False if is_alpha_masked is false for every polygon of the triangle.
  bool may_be_alpha_masked(std::uint32_t triangle) const;

  const Appearance& appearance() const;

  /// Bytes of the decoded textures and tables.
  std::uint64_t bytes() const;

 private:
  struct Tables;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace voxdag
