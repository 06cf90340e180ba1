#include "voxdag/algebra/contact/contacts.hpp"

#include <cmath>
#include <string>

#include "voxdag/algebra/contact/core_distance.hpp"
#include "voxdag/algebra/contact/least_cell.hpp"
#include "voxdag/algebra/contact/shape_costs.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

void check_reach(const Grid& grid, Vec3d voxels, const char* what) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::fabs(voxels[axis]) <= kMaxReach))
      throw Error(std::string(what) + (std::isfinite(voxels[axis] * grid.voxel_size)
                                           ? " is more than 2^40 voxels"
                                           : " is not finite"));
}

/// Returns a point in voxels.
Vec3d point_in(const Grid& grid, Vec3d world, const char* what) {
  const Vec3d voxels = grid.to_grid(world);
  check_reach(grid, voxels, what);
  return voxels;
}

/// Returns a length in voxels.
double size_in(const Grid& grid, double world, const char* what) {
  if (world < 0) throw Error(std::string(what) + " is negative");
  const double voxels = world / grid.voxel_size;
  check_reach(grid, {voxels, 0, 0}, what);
  return voxels;
}

/// A capsule in voxels.
struct GridCapsule {
  ShapeCore core;
  double radius = 0;

  GridCapsule(const Grid& grid, const Capsule& shape)
      : core{point_in(grid, shape.from, "a point"), {}},
        radius(size_in(grid, shape.radius, "the radius")) {
    if (shape.to != shape.from) core.along = point_in(grid, shape.to, "a point") - core.from;
  }
};

OrientedBox box_in(const Grid& grid, const OrientedBox& shape) {
  OrientedBox box{point_in(grid, shape.centre, "the centre"), {}};
  for (int axis = 0; axis < 3; ++axis) {
    box.half[axis] = size_in(grid, shape.half[axis], "the size of the box");
    box.axes[axis] = shape.axes[axis];
    if (!(std::fabs(length(box.axes[axis]) - 1) < 1e-6))
      throw Error("the axes of the box do not have unit length");
    for (int other = 0; other < axis; ++other)
      if (!(std::fabs(dot(box.axes[axis], box.axes[other])) < 1e-6))
        throw Error("the axes of the box are not at right angles");
  }
  return box;
}

/// Returns a limit in voxels, which may be infinite.
double limit_in(const Grid& grid, double most) {
  if (std::isnan(most)) throw Error("the limit of distances is not a number");
  return most / grid.voxel_size;
}

template <class Cost>
bool is_touched(const ContactScene& scene, const Cost& cost) {
  if (scene.dag.is_empty()) return false;
  return LeastCell<CellKind::kVoxels, Ties::kAny, Cost>(scene.dag, cost, kNoCost).is_found();
}

std::optional<NearestVoxel> nearest_to(const SvdagView& dag, const ShapeCore& core, double most) {
  if (core.is_point()) return nearest_voxel(dag, core.from, most * most);
  if (dag.is_empty()) return std::nullopt;
  const SquaredDistance cost(core);
  const LeastCell<CellKind::kVoxels, Ties::kFirst, SquaredDistance> found(dag, cost, most * most);
  if (!found.is_found()) return std::nullopt;
  return NearestVoxel{found.first(), found.cost()};
}

/// Returns the mean direction of the empty ones of the eight places around a point on the surface.
Vec3d direction_on_surface(const SvdagView& dag, Vec3d point) {
  Vec3d sum{};
  for (int i = 0; i < 8; ++i) {
    Vec3i place;
    Vec3d away;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = point[axis];
      const bool is_low = (i >> axis & 1) == 0;
      away[axis] = is_low ? -1 : 1;
      place[axis] = static_cast<std::int32_t>(is_low ? std::ceil(at) - 1 : std::floor(at));
    }
    sum = svdag_contains(dag, place, dag.levels) ? sum - away : sum + away;
  }
  return normalized_or(sum, {});
}

/// Returns the vector from a point in a voxel to the nearest empty place, or one longer than
/// `most`.
Vec3d way_out(const SvdagView& dag, Vec3d point, double most) {
  Vec3d way{};
  double least2 = kNoCost;
  const double side = std::ldexp(1.0, dag.levels);
  for (int axis = 0; axis < 3; ++axis)
    for (const double wall : {0.0, side}) {
      const double depth = wall - point[axis];
      if (depth * depth >= least2) continue;
      least2 = depth * depth;
      way = {};
      way[axis] = depth;
    }
  const SquaredPointDistance cost(point);
  const LeastCell<CellKind::kEmpty, Ties::kFirst, SquaredPointDistance> found(
      dag, cost, std::min(least2, most * most));
  return found.is_found() ? -Cube(found.first(), found.side()).to(point) : way;
}

/// Answers all questions on all threads. Checks them first, so that the error names the first bad
/// one, whatever the number of threads.
template <class Check, class Answer>
void answer_all(std::size_t count, Work work, const Check& check, const Answer& answer) {
  std::size_t i = 0;
  try {
    for (; i < count; ++i) check(i);
  } catch (const Error& error) {
    throw Error("", "shape " + std::to_string(i), error.reason());
  }
  polled_for(count, 64, work, "contacts", answer);
}

}  // namespace

bool overlaps(const ContactScene& scene, const Capsule& shape) {
  const GridCapsule capsule(scene.grid, shape);
  return is_touched(scene, CapsuleTouch(capsule.core, capsule.radius));
}

bool overlaps(const ContactScene& scene, const OrientedBox& shape) {
  return is_touched(scene, BoxTouch(box_in(scene.grid, shape)));
}

SweepHit sweep(const ContactScene& scene, const Capsule& shape, Vec3d motion) {
  const GridCapsule capsule(scene.grid, shape);
  const Vec3d steps = motion * (1 / scene.grid.voxel_size);
  check_reach(scene.grid, steps, "the motion");
  if (scene.dag.is_empty()) return {};
  const TouchTime cost(capsule.core, capsule.radius, steps);
  const LeastCell<CellKind::kVoxels, Ties::kAny, TouchTime> found(scene.dag, cost, 1);
  if (!found.is_found()) return {};
  const double t = found.cost();
  Vec3i voxel = found.first();
  if (t == 0) {
    const ApproachedDistance distance(capsule.core, capsule.radius, steps);
    const LeastCell<CellKind::kVoxels, Ties::kFirst, ApproachedDistance> nearest(scene.dag,
                                                                                 distance, kNoCost);
    if (nearest.is_found()) voxel = nearest.first();
  }
  const ShapeCore core = cost.core_at(t);
  const Cube cube(voxel, 1);
  const Vec3d near = core.at(core.nearest(cube));
  return {true, t, voxel, scene.grid.to_world(near - cube.to(near)), cost.normal(voxel)};
}

ClosestVoxel closest(const ContactScene& scene, const Capsule& shape, double most) {
  const GridCapsule capsule(scene.grid, shape);
  const double reach = limit_in(scene.grid, most) + capsule.radius;
  if (!(reach >= 0)) return {};
  const auto found = nearest_to(scene.dag, capsule.core, reach);
  if (!found) return {};
  const Cube cube(found->voxel, 1);
  const Vec3d near = capsule.core.at(capsule.core.nearest(cube)), apart = cube.to(near);
  return {true, (std::sqrt(found->distance2) - capsule.radius) * scene.grid.voxel_size,
          found->voxel, scene.grid.to_world(near - apart), normalized_or(apart, {})};
}

SignedDistance signed_distance(const ContactScene& scene, Vec3d point, double most) {
  const Vec3d at = point_in(scene.grid, point, "a point");
  const double limit = limit_in(scene.grid, most);
  if (limit < 0) throw Error("the limit of distances is negative");
  const auto found = nearest_voxel(scene.dag, at, limit * limit);
  if (!found) return {most, {}};
  const bool is_inside = found->distance2 == 0;
  const Vec3d way = is_inside ? way_out(scene.dag, at, limit) : Cube(found->voxel, 1).to(at);
  const double distance = length(way);
  if (distance == 0) return {0, direction_on_surface(scene.dag, at)};
  if (distance > limit) return {-most, {}};
  return {(is_inside ? -distance : distance) * scene.grid.voxel_size, way * (1 / distance)};
}

void overlaps(const ContactScene& scene, std::span<const Capsule> shapes, std::span<bool> results,
              Work work) {
  answer_all(
      shapes.size(), work, [&](std::size_t i) { GridCapsule(scene.grid, shapes[i]); },
      [&](std::size_t i) { results[i] = overlaps(scene, shapes[i]); });
}

void overlaps(const ContactScene& scene, std::span<const OrientedBox> shapes,
              std::span<bool> results, Work work) {
  answer_all(
      shapes.size(), work, [&](std::size_t i) { box_in(scene.grid, shapes[i]); },
      [&](std::size_t i) { results[i] = overlaps(scene, shapes[i]); });
}

void sweep(const ContactScene& scene, std::span<const Capsule> shapes,
           std::span<const Vec3d> motions, std::span<SweepHit> results, Work work) {
  answer_all(
      shapes.size(), work,
      [&](std::size_t i) {
        GridCapsule(scene.grid, shapes[i]);
        check_reach(scene.grid, motions[i] * (1 / scene.grid.voxel_size), "the motion");
      },
      [&](std::size_t i) { results[i] = sweep(scene, shapes[i], motions[i]); });
}

void closest(const ContactScene& scene, std::span<const Capsule> shapes, double most,
             std::span<ClosestVoxel> results, Work work) {
  limit_in(scene.grid, most);
  answer_all(
      shapes.size(), work, [&](std::size_t i) { GridCapsule(scene.grid, shapes[i]); },
      [&](std::size_t i) { results[i] = closest(scene, shapes[i], most); });
}

void signed_distance(const ContactScene& scene, std::span<const Vec3d> points, double most,
                     std::span<SignedDistance> results, Work work) {
  if (limit_in(scene.grid, most) < 0) throw Error("the limit of distances is negative");
  answer_all(
      points.size(), work, [&](std::size_t i) { point_in(scene.grid, points[i], "a point"); },
      [&](std::size_t i) { results[i] = signed_distance(scene, points[i], most); });
}

}  // namespace voxdag
