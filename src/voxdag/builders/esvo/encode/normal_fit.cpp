#include "voxdag/builders/esvo/encode/normal_fit.hpp"

#include <algorithm>

namespace voxdag {
namespace {

FloatLanes lanes_at(const float* values, int group) { return load_lanes(values + group * kLanes); }

float sum_of(FloatLanes v) { return (v[0] + v[1]) + (v[2] + v[3]); }

struct LanesVec {
  FloatLanes x = {}, y = {}, z = {};

  void add(FloatLanes scale, const LanesVec& v) {
    x += scale * v.x, y += scale * v.y, z += scale * v.z;
  }
  Vec3f sum() const { return {sum_of(x), sum_of(y), sum_of(z)}; }
};

/// The differences from the grid points of four normals to the nearest points on the normals' rays,
/// and the normals' weights. The angle of a difference is inversely proportional to the point's
/// distance.
struct Residuals {
  LanesVec difference;
  FloatLanes weight;

  Residuals(const NormalValues& values, const NormalFit& points, const RealGrid& grid, int group) {
    const FloatLanes cu = lanes_at(points.cu, group), cv = lanes_at(points.cv, group);
    const FloatLanes px = cu * grid.u.x + cv * grid.v.x + grid.base.x,
                     py = cu * grid.u.y + cv * grid.v.y + grid.base.y,
                     pz = cu * grid.u.z + cv * grid.v.z + grid.base.z;
    const FloatLanes x = lanes_at(values.x, group), y = lanes_at(values.y, group),
                     z = lanes_at(values.z, group);
    const FloatLanes distance = px * x + py * y + pz * z;
    difference = {x * distance - px, y * distance - py, z * distance - pz};
    weight =
        distance > 0.05f ? lanes_at(values.weight, group) / (distance * distance) : all_lanes(0.0f);
  }
};

int group_count(const NormalValues& values) {
  return (static_cast<int>(values.count) + kLanes - 1) / kLanes;
}

/// Returns `grid` fitted by least squares to the normals that `points` assigns to its points.
/// Parameters that they do not determine stay unchanged.
RealGrid fitted(const NormalValues& values, const NormalFit& points, RealGrid grid) {
  FloatLanes w_sum = {}, u_sum = {}, v_sum = {}, uu_sum = {}, uv_sum = {}, vv_sum = {};
  LanesVec r_sum, ru_sum, rv_sum;
  for (int group = 0; group < group_count(values); ++group) {
    const Residuals residuals(values, points, grid, group);
    const FloatLanes wu = residuals.weight * lanes_at(points.cu, group),
                     wv = residuals.weight * lanes_at(points.cv, group);
    w_sum += residuals.weight, u_sum += wu, v_sum += wv;
    uu_sum += wu * lanes_at(points.cu, group), vv_sum += wv * lanes_at(points.cv, group);
    uv_sum += wu * lanes_at(points.cv, group);
    r_sum.add(residuals.weight, residuals.difference);
    ru_sum.add(wu, residuals.difference);
    rv_sum.add(wv, residuals.difference);
  }
  const float w = sum_of(w_sum);
  if (!(w > 0.0f)) return grid;
  // Relative to the weighted means of cu and cv, the base drops out of the system.
  const float wu = sum_of(u_sum), wv = sum_of(v_sum), mean_u = wu / w, mean_v = wv / w;
  const float stay = 1e-3f * w;
  const float a = sum_of(uu_sum) + stay - mean_u * wu, b = sum_of(uv_sum) - mean_u * wv,
              c = sum_of(vv_sum) + stay - mean_v * wv;
  const Vec3f r = r_sum.sum(), ru = ru_sum.sum() - r * mean_u, rv = rv_sum.sum() - r * mean_v;
  const float scale = 1.0f / (a * c - b * b);
  const Vec3f du = (ru * c - rv * b) * scale, dv = (rv * a - ru * b) * scale;
  grid.base = grid.base + r * (1.0f / w) - du * mean_u - dv * mean_v;
  grid.u = grid.u + du;
  grid.v = grid.v + dv;
  return grid;
}

/// Returns the change of the v axis for a change of the u axis, by least squares: the slope of cu
/// over cv.
float slope(const NormalValues& values, const NormalFit& points) {
  FloatLanes u_sum = {}, v_sum = {}, uv_sum = {}, vv_sum = {};
  for (int group = 0; group < group_count(values); ++group) {
    const FloatLanes weight = lanes_at(values.weight, group), cu = lanes_at(points.cu, group),
                     cv = lanes_at(points.cv, group);
    u_sum += weight * cu, v_sum += weight * cv;
    uv_sum += weight * cu * cv, vv_sum += weight * cv * cv;
  }
  const float mean_v = sum_of(v_sum) / values.total_weight;
  const float vv = sum_of(vv_sum) - mean_v * sum_of(v_sum);
  if (!(vv > 0.01f * values.total_weight)) return 0.0f;
  return (sum_of(uv_sum) - mean_v * sum_of(u_sum)) / vv;
}

/// Rounds the grid to its stored form in `fit`, as precisely as possible, and assigns its points to
/// the normals. On entry `fit` has the points of the unrounded grid.
void store(const NormalValues& values, const RealGrid& grid, NormalFit& fit) {
  const float scale = 1.0f / longest_side(grid.base);
  const Vec3f u = grid.u * scale, v = grid.v * scale, direction = unit_vector(grid.base);
  const float bend = std::min(0.3f * (dot(u, u) + dot(v, v)), 1.0f);
  fit.u = nearest_axis(u, direction, bend);
  // If cu and cv are proportional, v absorbs the rounding error of u. This fits two directions.
  const Vec3f missing = u - fit.u.vector();
  const Vec3f across = missing - direction * dot(missing, direction);
  fit.v = nearest_axis(v + across * slope(values, fit), direction, bend);
  const RealGrid axes{grid.base * scale, fit.u.vector(), fit.v.vector()};
  const RealGrid moved = settled_grid(values, fit, axes);
  fit.base = nearest_cube_point(is_lost(moved) ? grid.base : moved.base);
  fit_points(values, fit);
}

}  // namespace

RealGrid settled_grid(const NormalValues& values, const NormalFit& points, RealGrid grid) {
  LanesVec sum;
  FloatLanes weight = {};
  for (int group = 0; group < group_count(values); ++group) {
    const Residuals residuals(values, points, grid, group);
    sum.add(residuals.weight, residuals.difference);
    weight += residuals.weight;
  }
  const float total = sum_of(weight);
  if (total > 0.0f) grid.base = grid.base + sum.sum() * (1.0f / total);
  return grid;
}

void consider_grid(const NormalValues& values, const RealGrid& grid, const NormalFit& start,
                   int rounds, NormalFit& best) {
  NormalFit fit = start;
  RealGrid real = fitted(values, fit, grid);
  if (is_lost(real)) real = grid;
  store(values, real, fit);
  while (--rounds > 0) {
    NormalFit next = fit;
    real = fitted(values, fit, fit.grid());
    if (is_lost(real)) break;
    store(values, real, next);
    if (!(next.error < fit.error)) break;
    const bool was_worth_it = next.error < 0.9f * fit.error;
    fit = next;
    if (!was_worth_it) break;
  }
  if (fit.error < best.error) best = fit;
}

void consider_grid(const NormalValues& values, const RealGrid& grid, int rounds, NormalFit& best) {
  const float scale = 1.0f / longest_side(grid.base);
  const Vec3f direction = unit_vector(grid.base);
  NormalFit start{};
  start.base = nearest_cube_point(grid.base);
  start.u = nearest_axis(grid.u * scale, direction, 1.0f);
  start.v = nearest_axis(grid.v * scale, direction, 1.0f);
  fit_points(values, start);
  consider_grid(values, start.grid(), start, rounds, best);
}

}  // namespace voxdag
