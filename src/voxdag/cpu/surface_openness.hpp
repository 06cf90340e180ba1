#pragma once
/// Ambient occlusion at points of a surface, for baking.
#include "voxdag/core/grid.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/render/sample_tables.hpp"

namespace voxdag {

/// Computes which part of the sky's light passes the voxels near a point and reaches it, like
/// render/ambient_occlusion.hpp for a pixel. All points have the same ray directions, so that
/// neighbours on a wall get similar values. Thread-safe.
class SurfaceOpenness {
 public:
  /// Points to the voxels, which are in `grid`. Casts `rays` >= 1 rays per point. `distance` > 0 is
  /// the reach of occlusion, in world units.
  SurfaceOpenness(const VoxelSet& voxels, const Grid& grid, int rays, double distance);

  /// Returns 0 (no light arrives) to 1. `point`, in world units, lies on a surface with the unit
  /// shading normal `normal`, on a triangle with the unit normal `face`: rays run on that side of
  /// it.
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
