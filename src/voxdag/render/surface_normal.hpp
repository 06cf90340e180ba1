#pragma once
/// Estimates a smooth surface at a cell from the cells around it.
///
/// The voxels of a surface form a layer. Let C be the covariance of the occupied cells within 4.5
/// cells, with weights that fall to zero at that distance. Its eigenvalues are small across the
/// layer and large along it. So a power of its inverse turns a vector v towards the layer's normal:
/// the result is C^-4 v, normalised. Here v is half way between the direction to the viewer and the
/// normal of the entered face. This method needs no eigenvectors and stays on v's side. It rounds
/// edges over a few cells, gives hair a normal across its axis, and falls back to v if there is no
/// layer.
#include "voxdag/core/bits.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/render/camera.hpp"
#include "voxdag/render/sky.hpp"
#include "voxdag/trace/cell_blocks.hpp"

namespace voxdag {

/// A symmetric 3×3 matrix of second moments.
struct CovarianceMatrix {
  float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  VOXDAG_HD Vec3f operator*(Vec3f v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
            xz * v.x + yz * v.y + zz * v.z};
  }
  VOXDAG_HD void add_outer_product(Vec3f v, float weight) {
    xx += weight * v.x * v.x;
    yy += weight * v.y * v.y;
    zz += weight * v.z * v.z;
    xy += weight * v.x * v.y;
    xz += weight * v.x * v.z;
    yz += weight * v.y * v.z;
  }
  /// Returns the inverse times the determinant.
  VOXDAG_HD CovarianceMatrix adjugate() const {
    return {yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy,
            xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - xx * yz};
  }
};

/// The layer of cells around a point, whatever the viewer.
struct SurfaceLayer {
  bool is_empty = true;
  Vec3f mean{};  ///< From the point to the mean of the cells, in cells.
  CovarianceMatrix covariance;
};

/// A layer as it is seen from one side.
struct LayerFit {
  Vec3f normal;         ///< Unit length.
  float thickness = 0;  ///< Variance of the cells along the normal, in cells².
};

/// The smooth surface at a cell.
struct SmoothSurface {
  Vec3f normal;       ///< Unit length.
  float height = 0;   ///< Of the surface above the cell's centre along the normal, in cells.
  float is_flat = 0;  ///< 1 where the height is that of a layer, 0 at edges.
};

/// The numbers of fit_layer() and surface_normal(). Thicknesses are variances along the normal, in
/// cells²: those of planes are 0.1 to 0.2 near an axis and at most 0.34, that of right-angled edges
/// is 0.5.
struct LayerRule {
  static constexpr float kRadius = 4.5f;  ///< Farther cells do not count.
  static constexpr float kPerRadius2 = 1 / (kRadius * kRadius);
  static constexpr int kPower = 4;  ///< Steps of the power iteration that finds the normal.
  /// The normal of a coarser level counts fully up to kThin, and not at all from kThick on.
  static constexpr float kThin = 0.20f, kThick = 0.30f;
  /// A layer is a plane up to kPlane, and an edge from kEdge on.
  static constexpr float kPlane = 0.36f, kEdge = 0.50f;
  /// Edges whose normal has a smaller cosine with the view are outlines.
  static constexpr float kOutlineCosine = 0.25f;
  static constexpr int kCoarser = 2;  ///< Number of coarser levels that refine the normal.
};

/// Sums over the cells of a layer, with weights that fall from 1 at the point to 0 at kRadius.
struct LayerSums {
  float weight = 0;
  Vec3f mean{};              ///< Not divided by the weight; neither are the moments.
  CovarianceMatrix moments;  ///< About the point.

  /// Adds the cells of a block of 4³ cells. `base` leads from the point to its first cell's centre.
  VOXDAG_HD void add(std::uint64_t cells, Vec3f base) {
    for (; cells != 0; cells &= cells - 1) {
      const auto i = static_cast<std::uint32_t>(lowest_bit64(cells));
      const Vec3f d = base + Vec3f{static_cast<float>((i & 1u) | (i >> 2 & 2u)),
                                   static_cast<float>((i >> 1 & 1u) | (i >> 3 & 2u)),
                                   static_cast<float>((i >> 2 & 1u) | (i >> 4 & 2u))};
      const float fall = 1 - dot(d, d) * LayerRule::kPerRadius2;
      if (fall <= 0) continue;
      const float w = fall * fall;
      weight += w;
      mean = mean + d * w;
      moments.add_outer_product(d, w);
    }
  }
  VOXDAG_HD LayerSums total() const { return *this; }
};

/// Returns the layer around the centre of `cell` of `level`, of cells of `level - up`, at least 2.
/// `Sums` adds as LayerSums does.
template <class Sums = LayerSums, class Nodes>
VOXDAG_HD inline SurfaceLayer find_layer(const Nodes& nodes, int level, Vec3i cell, int up) {
  const Vec3i around{cell.x >> up, cell.y >> up, cell.z >> up};
  const float size = 1.0f / static_cast<float>(1 << up);
  const Vec3f half{0.5f, 0.5f, 0.5f};
  const Vec3f offset = (static_cast<Vec3f>(cell - around * (1 << up)) + half) * size - half;
  // On each axis two blocks of 4³ cells cover at least 4 cells on both sides of the cell.
  const auto first = [](std::int32_t i) { return (i >> 2) - ((i & 3) < 2 ? 1 : 0); };
  const Vec3i block{first(around.x), first(around.y), first(around.z)};
  const CellBlocks blocks = cell_blocks(nodes, level - up, block);
  Sums adding;
  for (int corner = 0; corner < 8; ++corner)
    adding.add(blocks.masks[corner],
               static_cast<Vec3f>((block + child_offset(corner)) * 4 - around) - offset);
  const LayerSums sums = adding.total();
  if (!(sums.weight > 0)) return {};
  // The variance of a cell's own extent, 1/12, keeps the matrix regular.
  CovarianceMatrix covariance{1.0f / 12, 1.0f / 12, 1.0f / 12};
  const float scale = 1 / sums.weight;
  const Vec3f mean = sums.mean * scale;
  covariance.xx += sums.moments.xx * scale;
  covariance.yy += sums.moments.yy * scale;
  covariance.zz += sums.moments.zz * scale;
  covariance.xy += sums.moments.xy * scale;
  covariance.xz += sums.moments.xz * scale;
  covariance.yz += sums.moments.yz * scale;
  covariance.add_outer_product(mean, -1);
  return {false, mean, covariance};
}

/// Returns the layer as it is seen from the side to which `front` points.
VOXDAG_HD inline LayerFit fit_layer(const SurfaceLayer& layer, Vec3f front) {
  if (layer.is_empty) return {front, 0};
  const CovarianceMatrix inverse = layer.covariance.adjugate();
  Vec3f normal = front;
  for (int i = 0; i < LayerRule::kPower; ++i) normal = normalized(inverse * normal);
  return {normal, dot(normal, layer.covariance * normal)};
}

/// Finds each layer anew.
struct FreshLayers {
  template <class Nodes>
  VOXDAG_HD SurfaceLayer find(const Nodes& nodes, int level, Vec3i cell, int up) const {
    return find_layer(nodes, level, cell, up);
  }
};

/// Returns the surface at `cell` of `level` (2..L), with a normal of unit length. `view` is the
/// unit vector to the viewer, `face` the normal of the face that the ray entered (or `view`). At
/// outlines these two can lie on different sides of the layer. Then the side on which the cell lies
/// counts as the outer side, because outlines are convex. Where an edge turns away from the viewer,
/// the normal is `face`. `layers` finds the layers: FreshLayers or a LayerCache.
template <class Nodes, class Layers>
VOXDAG_HD inline SmoothSurface smooth_surface(const Nodes& nodes, int level, Vec3i cell, Vec3f view,
                                              Vec3f face, Layers& layers) {
  using Rule = LayerRule;
  const Vec3f front = normalized(view + face);
  const SurfaceLayer layer = layers.find(nodes, level, cell, 0);
  const LayerFit fine = fit_layer(layer, front);
  Vec3f normal = fine.normal;
  const float edge = smooth_step(Rule::kPlane, Rule::kEdge, fine.thickness);
  if ((dot(normal, view) < 0) != (dot(normal, face) < 0) && dot(normal, layer.mean) > 0)
    normal = -normal;
  const float outline = edge * smooth_step(Rule::kOutlineCosine, 0, dot(normal, view));
  normal = normalized(mix(normal, face, outline));
  for (int up = 1; up <= Rule::kCoarser && level - up >= 2; ++up) {
    const LayerFit fit = fit_layer(layers.find(nodes, level, cell, up), normal);
    const float trust = smooth_step(Rule::kThick, Rule::kThin, fit.thickness);
    if (trust <= 0) break;
    normal = normalized(mix(normal, fit.normal, trust));
  }
  return {normal, dot(normal, layer.mean), 1 - edge};
}

}  // namespace voxdag
