#pragma once
/// The view samples of rays at an ESVO: shapes cut by contours, with colours and normals.
#include "voxdag/render/surface_point.hpp"
#include "voxdag/render/voxel_view_samples.hpp"
#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {

/// Returns the deepest contour of the hit voxel and its ancestors, if there is one.
VOXDAG_HD inline ContourPlane deepest_contour(const EsvoView& esvo, const GridRay& ray,
                                              const EsvoHit& hit) {
  ContourPlane deepest;
  std::uint64_t slot = esvo.root;
  for (int level = 1;; ++level) {
    const int bit = 23 - level;
    const std::uint32_t mirrored =
        (hit.x >> bit & 1u) | (hit.y >> bit & 1u) << 1 | (hit.z >> bit & 1u) << 2;
    const auto child = static_cast<int>(mirrored ^ ray.mirrored);
    const ChildDescriptor parent = esvo.descriptor(slot);
    if ((parent.contour_mask() >> child & 1u) != 0)
      deepest = {esvo.contour(slot, parent, child), level};
    if (level == hit.level) return deepest;
    slot = esvo.child(slot, parent, child);
  }
}

/// Does for an ESVO what view_sample_of() in voxel_view_samples.hpp does for a DAG. It has normals
/// and contours, and needs no layers.
template <EsvoLayout Nodes, class Layers>
VOXDAG_HD inline ViewSample view_sample_of(const Nodes& nodes, const RenderSetup& setup,
                                           const SightLine& line, const GridRay& ray,
                                           const EsvoHit& hit, double depth, Layers& /*layers*/) {
  // The height to which the shapes of neighbours may rise above the visible plane: in units of the
  // slab's thickness, and in units of the cells that represent a surface at this depth.
  constexpr float kSlabs = 1.0f, kCells = 0.5f;
  constexpr float kTrusted = 0.5f;  // a cosine
  const EsvoView& esvo = nodes.view();
  const double t = ray.to_world_t(static_cast<double>(hit.t));
  const auto side = static_cast<float>(setup.side());
  const float voxel_size =
      side * float_from_bits(static_cast<std::uint32_t>(127 - hit.level) << 23);
  const float visible_size = cell_size_at(setup, depth);
  const Vec3f view = -static_cast<Vec3f>(normalized(line.direction));
  const Vec3f entered = entered_normal(ray, hit);
  const Vec3f plane = dot(entered, entered) > 0 ? entered : view;
  const ContourPlane deepest =
      Nodes::kWithContours ? deepest_contour(esvo, ray, hit) : ContourPlane{};

  ViewSample sample;
  sample.albedo = setup.settings.albedo;
  stored_color(esvo, hit.voxel, sample.albedo);
  sample.normal = plane;
  if (stored_normal(esvo, hit.voxel, sample.normal)) {
    const bool is_back = hit.is_through_contour() ? dot(sample.normal, plane) < 0
                                                  : is_of_back(sample.normal, view, plane);
    if (is_back) sample.normal = -sample.normal;
    // The mean normal of the two sides of a cloth fits neither side. So its weight falls with its
    // angle to the visible plane.
    if (hit.is_through_contour()) {
      const float trust = smooth_step(0, kTrusted, dot(sample.normal, plane));
      sample.normal = normalized(mix(plane, sample.normal, trust));
    }
  }
  sample.depth = static_cast<float>(t);
  // A leaf may be much coarser than the voxels that cast shadows on it.
  sample.cell_size = voxel_size;
  sample.detail_size = visible_size < voxel_size ? visible_size : voxel_size;
  sample.point = line.origin + line.direction * t;
  if (hit.is_through_contour()) {
    sample.face = plane;
  } else {
    const float pixels = voxel_size / static_cast<float>(setup.camera.pixel_size() * depth);
    const float cube =
        smooth_step(setup.settings.cube_pixels / 2, setup.settings.cube_pixels, pixels);
    const bool is_cube = deepest.contour.bits == 0;
    sample.face = is_cube ? normalized(mix(sample.normal, plane, cube)) : sample.normal;
  }
  // As for the cubes of a DAG, this side of the cube may lie below the surface's plane.
  const float below = cube_height(sample.face) - dot(sample.face, plane);
  sample.lift = (cube_height(sample.face) + (below > 0 ? below : 0.0f) + kCells) * voxel_size;
  // The contours' slabs may be thinner. The visible plane may belong to an ancestor with a thick
  // slab, but nothing in the ancestor's cube rises above that plane.
  for (const ContourPlane& slab : {hit.plane, deepest}) {
    if (slab.contour.bits == 0) continue;
    const float above = kSlabs * thickness(slab) * side + kCells * sample.detail_size;
    sample.lift = above < sample.lift ? above : sample.lift;
  }
  return sample;
}

}  // namespace voxdag
