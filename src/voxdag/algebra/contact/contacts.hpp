#pragma once
/// Contacts of shapes with voxels, in world units: overlaps, sweeps, closest points and signed
/// distances. docs/contacts.md draws the rules.
///
/// A voxel is its closed cube. Distances are computed in double precision, in voxels that count
/// from the grid's corner: coordinates are rounded to 2^-52 of themselves, and no other error is
/// larger than kTouch. All functions throw Error for coordinates, radii and motions that are not
/// finite or reach farther than kMaxReach voxels, and for negative sizes. They may run on several
/// threads.
///
/// Functions with spans answer question i in place i, on all threads; results do not depend on
/// their number. Spans must have equal lengths. Errors name the number of the shape, from 0 on.
/// They throw Cancelled.
#include <cstdint>
#include <limits>
#include <span>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Shapes whose distance is at most this touch, in voxels.
inline constexpr double kTouch = 1e-9;
/// The largest coordinate, size and motion, in voxels.
inline constexpr double kMaxReach = double(std::int64_t{1} << 40);

/// Voxels and their place. The DAG may be a version that is being edited (EditSnapshot::view()).
struct ContactScene {
  SvdagView dag;
  Grid grid;
};

/// All points at most `radius` from the segment between two points, its core: a sphere if they are
/// equal, and a point if the radius is 0.
struct Capsule {
  Vec3d from, to;
  double radius = 0;

  static Capsule sphere(Vec3d centre, double radius) { return {centre, centre, radius}; }
};

/// A box of size 2 `half`. `axes` are the directions of its sides, of unit length and at
/// right angles, both within 1e-6.
struct OrientedBox {
  Vec3d centre, half;
  Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// Returns whether a shape touches a voxel.
bool overlaps(const ContactScene& scene, const Capsule& shape);
bool overlaps(const ContactScene& scene, const OrientedBox& shape);

/// The first contact of a moving shape with a voxel.
struct SweepHit {
  bool hit = false;
  double t = 1;             ///< The part of the motion until then, 0 to 1.
  Vec3i voxel{-1, -1, -1};  ///< One of those that are touched.
  Vec3d point{};            ///< The place where the shape touches the voxel.
  /// The direction from the voxel to the core, of unit length; 0 if the core touches the voxel at
  /// the start.
  Vec3d normal{};
};

/// Moves a shape along `motion` until it touches a voxel that it approaches: at t its distance to
/// the voxel is at most kTouch, and at no time before. A shape that touches a voxel at the start
/// meets it at t = 0, unless the motion leads away from it or along it; if the core itself touches
/// the voxel, it meets it in any case.
SweepHit sweep(const ContactScene& scene, const Capsule& shape, Vec3d motion);

/// The voxel that is nearest to a shape.
struct ClosestVoxel {
  bool is_found = false;
  /// The distance from the voxel to the core, less the radius: negative where they overlap.
  double distance = std::numeric_limits<double>::infinity();
  /// Among several equally near: the one that contains the point, if the shape is a point, else the
  /// one with the least x, then y, then z.
  Vec3i voxel{-1, -1, -1};
  Vec3d point{};   ///< The voxel's point that is nearest to the core.
  Vec3d normal{};  ///< From there to the core, of unit length; 0 if the core touches the voxel.
};

/// Returns the voxel that is nearest to a shape, if the distance is at most `most`.
ClosestVoxel closest(const ContactScene& scene, const Capsule& shape,
                     double most = std::numeric_limits<double>::infinity());

struct SignedDistance {
  double distance = 0;
  Vec3d gradient{};  ///< Of unit length, or 0 where there is none.
};

/// Returns the distance to the surface of the voxels: outside of them to the nearest voxel, and in
/// them, negative, to the nearest empty place. All places outside of the grid are empty. The
/// gradient leads away from the nearest voxel, or to the nearest empty place. On the surface it is
/// the mean direction of the empty ones of the eight places around. A sphere of radius r about the
/// point penetrates the voxels by r - distance: no shorter motion can free it, and one of this
/// length along the gradient does if the surface is flat there. Distances beyond `most` become
/// `most`, or -most, and the gradient 0.
SignedDistance signed_distance(const ContactScene& scene, Vec3d point,
                               double most = std::numeric_limits<double>::infinity());

void overlaps(const ContactScene& scene, std::span<const Capsule> shapes, std::span<bool> results,
              Work work = {});
void overlaps(const ContactScene& scene, std::span<const OrientedBox> shapes,
              std::span<bool> results, Work work = {});
void sweep(const ContactScene& scene, std::span<const Capsule> shapes,
           std::span<const Vec3d> motions, std::span<SweepHit> results, Work work = {});
void closest(const ContactScene& scene, std::span<const Capsule> shapes, double most,
             std::span<ClosestVoxel> results, Work work = {});
void signed_distance(const ContactScene& scene, std::span<const Vec3d> points, double most,
                     std::span<SignedDistance> results, Work work = {});

}  // namespace voxdag
