#pragma once
/// Ambient occlusion at points of a surface, for baking.
#include "voxdag/core/grid.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/render/sample_tables.hpp"

namespace voxdag {

/// Computes the fraction of the sky's light that reaches a point past the voxels near it, as
/// render/ambient_occlusion.hpp does for a pixel. All points have the same ray directions, so that
/// neighbours on a wall get similar values. Thread-safe.
class SurfaceOpenness {
 public:
  /// Points to `voxels`, which must outlive this object; `grid` is their grid. Casts `rays` >= 1
  /// rays per point, of the length `distance` > 0 in world units.
  SurfaceOpenness(const VoxelSet& voxels, const Grid& grid, int rays, double distance);

  /// Returns 0 (no light arrives) to 1. `point`, in world units, lies on a triangle with the unit
  /// normal `face`; rays start on that side. `normal` is the unit shading normal.
  float operator()(Vec3d point, Vec3f normal, Vec3f face) const;

 private:
  template <class Nodes, class Caster>
  float open_part(const Nodes& nodes, const Caster& caster, Vec3d point, Vec3f normal,
                  Vec3f face) const;

  CpuScene scene_;
  Grid grid_;
  int rays_;
  float distance_;  // in units of the grid's side
  SampleSets samples_;
};

}  // namespace voxdag
