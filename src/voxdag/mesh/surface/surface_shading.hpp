#pragma once
/// Computes colour, coverage and normal of pieces of a mesh's surface: the appearance of a voxel.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

struct SurfaceTables;

struct SurfaceSample {
  /// Mean colour of the visible part, linear light; without such a part, the nearest visible
  /// colour.
  Vec3f color;
  float coverage = 1;  ///< Visible part of the area, 0 to 1.
  Vec3f normal;  ///< Mean of the unit normals: shorter where they disagree. Zero for a triangle
                 ///< without area or normals.
  MetallicRoughness metallic_roughness{};  ///< Mean of the numbers.
};

/// Refers to mesh and appearance, which must outlive it; owns the decoded textures. Immutable and
/// thread-safe. Polygons are convex and lie in their triangle. Each corner is given by two
/// barycentric coordinates: the weights of the triangle's corners 1 and 2. A polygon may have one
/// corner, two, or collinear ones. It may have none if the triangle has one colour and one normal.
class SurfaceShading {
 public:
  /// Decodes the textures. A texture that cannot be read is left out; a line in `warnings` names it
  /// and its replacement. Counts the textures and tables in `work` as long as they live. Without
  /// `with_metallic_roughness`, all samples have the default of these numbers. Throws Cancelled and
  /// OverMemory.
  SurfaceShading(const Mesh& mesh, const Appearance& appearance,
                 std::vector<std::string>* warnings = nullptr, Work work = {},
                 bool with_metallic_roughness = false);
  ~SurfaceShading();
  SurfaceShading(SurfaceShading&&) noexcept;

  /// Returns the mean appearance of a polygon. Textures are filtered by mip maps, with a footprint
  /// of the polygon's size and shape. Without `with_normal`, the sample's normal is zero.
  SurfaceSample mean(std::uint32_t triangle, std::span<const Vec2f> polygon,
                     bool with_normal = true) const;

  /// Returns whether the triangle's material has a normal map that was read.
  bool has_normal_map(std::uint32_t triangle) const;
  /// Returns whether the whole triangle is visible, has one colour and one pair of metallic and
  /// roughness.
  bool has_one_color(std::uint32_t triangle) const;
  /// Returns whether all normals of the triangle are equal.
  bool has_one_normal(std::uint32_t triangle) const;

  /// Returns true only if the whole polygon is visible (or invisible, if `mean.coverage` is 0), and
  /// every point has about the mean's colour and normal. Colours may differ by `color_error` in
  /// each channel (sRGB encoded, 0 to 1), normals by `normal_error` radians. The test is
  /// conservative: it may return false for such a polygon too.
  bool is_uniform(std::uint32_t triangle, std::span<const Vec2f> polygon, float color_error,
                  float normal_error, const SurfaceSample& mean) const;

  /// Returns false only if is_uniform() returns false with these errors for every mean. Uses only
  /// the bounds of the textures: much faster than mean() and is_uniform().
  bool may_be_uniform(std::uint32_t triangle, std::span<const Vec2f> polygon, float color_error,
                      float normal_error) const;

  /// Returns true only if no point of the polygon passes the alpha test. The test is conservative:
  /// it may return false for such a polygon too.
  bool is_alpha_masked(std::uint32_t triangle, std::span<const Vec2f> polygon) const;

  /// Returns whether a part of the polygon passes the alpha test. Unlike is_alpha_masked(), this
  /// leaves out the blur of the texture's filter: a texel is a square.
  bool is_visible(std::uint32_t triangle, std::span<const Vec2f> polygon) const;

  /// Returns false only if is_alpha_masked() is false for every polygon of the triangle.
  bool may_be_alpha_masked(std::uint32_t triangle) const;

  const Appearance& appearance() const;

  /// Returns the bytes of the decoded textures and tables.
  std::uint64_t bytes() const;

 private:
  std::unique_ptr<const SurfaceTables> tables_;
};

}  // namespace voxdag
