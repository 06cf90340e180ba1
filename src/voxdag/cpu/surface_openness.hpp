#pragma once
/// Ambient occlusion of points of a surface, for baking.
#include "voxdag/core/grid.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/render/sample_tables.hpp"

namespace voxdag {

/// Which part of the sky's light reaches a point past the voxels near it: what
/// render/ambient_occlusion.hpp computes for a pixel, with the same directions for all points, so
/// that neighbours on a wall get values alike. Safe to ask from several threads.
class SurfaceOpenness {
 public:
  /// Points to the voxels, which stand in `grid`. `rays` for each point, at least 1; `distance` in
  /// world units is how far occlusion reaches, positive.
  SurfaceOpenness(const VoxelSet& voxels, const Grid& grid, int rays, double distance);

  /// 0 (nothing arrives) to 1. `point` in world units, on a surface whose normal (of unit length)
  /// is `normal`, or, of the triangle that it is on, `face`: rays run on that side of it.
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
