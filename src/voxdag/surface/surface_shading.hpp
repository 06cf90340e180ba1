#pragma once
/// Computes colour, coverage and normal of pieces of a mesh's surface: the attributes of voxels.
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
/// thread-safe.
///
/// A polygon is convex and lies in its triangle. Its corners are barycentric coordinates (of the
/// triangle's corners 1 and 2). It may have one, two or collinear corners, and none if the triangle
/// has one colour and one normal.
class SurfaceShading {
 public:
  /// Decodes the textures. A texture that cannot be read is left out; `warnings` gets a line that
  /// names it and its replacement. `memory`, if not null, counts the textures and must outlive
  /// this. Throws Cancelled and OverMemory.
  SurfaceShading(const Mesh& mesh, const Appearance& appearance,
                 std::vector<std::string>* warnings = nullptr, Progress* progress = nullptr,
                 MemoryBudget* memory = nullptr);
  ~SurfaceShading();
  SurfaceShading(SurfaceShading&&) noexcept;

  /// Returns the means over a polygon. The footprint of texture look-ups has the polygon's size and
  /// shape.
  SurfaceSample mean(std::uint32_t triangle, std::span<const Vec2f> polygon) const;

  bool has_normal_map(std::uint32_t triangle) const;
  /// Returns whether the whole triangle is visible and has one colour.
  bool has_one_color(std::uint32_t triangle) const;
  /// Returns whether all normals of the triangle are equal.
  bool has_one_normal(std::uint32_t triangle) const;

  /// Returns whether the polygon is known to be uniform. If true, all of it is visible (or none, if
  /// `mean.coverage` is 0), every point's colour is within `color_error` of the mean's (largest
  /// difference of a channel, both encoded as sRGB in 0..1), and every normal is within
  /// `normal_error` radians of the mean's direction. Can return false for a uniform polygon.
  bool is_uniform(std::uint32_t triangle, std::span<const Vec2f> polygon, float color_error,
                  float normal_error, const SurfaceSample& mean) const;

  /// Returns false only if is_uniform() would return false for every mean. Tests the bounds of the
  /// textures, which is much faster than mean() and is_uniform().
  bool may_be_uniform(std::uint32_t triangle, std::span<const Vec2f> polygon, float color_error,
                      float normal_error) const;

  /// Returns true only if no point of the polygon passes the alpha test. Can return false for such
  /// a polygon.
  bool is_alpha_masked(std::uint32_t triangle, std::span<const Vec2f> polygon) const;

  /// Returns false only if is_alpha_masked() is false for every polygon of the triangle.
  bool may_be_alpha_masked(std::uint32_t triangle) const;

  const Appearance& appearance() const;

  /// Returns the bytes of the decoded textures and tables.
  std::uint64_t bytes() const;

 private:
  struct Tables;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace voxdag
