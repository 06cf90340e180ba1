/// Source: Laine, Karras, "Efficient Sparse Voxel Octrees", I3D 2010, Section 3.5, whose last
/// paragraph names the three kinds of grids tried here: across the normals' mean, along one line
/// with parallel axes, and through entirely different directions. Each kind starts with a grid of
/// real numbers. The encoder then repeats three steps: it rounds the grid to its stored form,
/// assigns its points to the normals, and fits the grid to them by least squares. If the normals
/// differ much, it finally changes the integers of the axes one by one while the error decreases.
#include "voxdag/builders/esvo/encode/encode_normal_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/builders/esvo/encode/normal_fit.hpp"
#include "voxdag/builders/pieces/principal_axis.hpp"
#include "voxdag/core/bits.hpp"

namespace voxdag {
namespace {

/// Mean squared chord above which more kinds of grids are tried: two degrees.
constexpr float kHard = 1.2e-3f;
/// Mean squared chords below which no other kind is tried: half a degree.
constexpr float kGood = kHard / 16;

/// The normals projected onto a plane across their mean, in the coordinates of the two principal
/// directions of the projected points.
struct PlaneView {
  Vec3f middle, along, across;
  float p[kValuesPerBlock], q[kValuesPerBlock];
  float low_p = INFINITY, high_p = -INFINITY, low_q = INFINITY, high_q = -INFINITY;

  PlaneView(const NormalValues& values, Vec3f mean) : middle(mean) {
    const Vec3f side =
        unit_vector(cross(middle, std::fabs(middle.x) < 0.6f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}));
    const Vec3f up = cross(middle, side);
    float mean_p = 0, mean_q = 0;
    for (std::size_t i = 0; i < values.count; ++i) {
      const float scale = 1.0f / dot(values.normal[i], middle);
      p[i] = dot(values.normal[i], side) * scale;
      q[i] = dot(values.normal[i], up) * scale;
      mean_p += values.weight[i] * p[i], mean_q += values.weight[i] * q[i];
    }
    mean_p /= values.total_weight, mean_q /= values.total_weight;
    float pp = 0, pq = 0, qq = 0;
    for (std::size_t i = 0; i < values.count; ++i) {
      const float dp = p[i] - mean_p, dq = q[i] - mean_q;
      pp += values.weight[i] * dp * dp, pq += values.weight[i] * dp * dq;
      qq += values.weight[i] * dq * dq;
    }
    // An eigenvector of the covariance matrix, computed from the sum without cancellation.
    const float half = 0.5f * (pp - qq), root = std::sqrt(half * half + pq * pq);
    float c = half >= 0.0f ? half + root : pq, s = half >= 0.0f ? pq : root - half;
    const float length = std::sqrt(c * c + s * s);
    c = length > 0.0f ? c / length : 1.0f;
    s = length > 0.0f ? s / length : 0.0f;
    along = side * c + up * s, across = up * c - side * s;
    for (std::size_t i = 0; i < values.count; ++i) {
      const float turned = c * p[i] + s * q[i];
      q[i] = c * q[i] - s * p[i];
      p[i] = turned;
      low_p = std::min(low_p, p[i]), high_p = std::max(high_p, p[i]);
      low_q = std::min(low_q, q[i]), high_q = std::max(high_q, q[i]);
    }
  }

  float half_p() const { return 0.5f * (high_p - low_p); }
  float half_q() const { return 0.5f * (high_q - low_q); }
  Vec3f center() const {
    return middle + along * (0.5f * (high_p + low_p)) + across * (0.5f * (high_q + low_q));
  }
};

/// Returns the index of the nearest of `steps` + 1 evenly spaced values from `low` to `high`.
int step_of(float value, float low, float high, float steps) {
  return static_cast<int>((value - low) * (steps / std::max(high - low, 1e-20f)) + 0.5f);
}

float coefficient(int step) { return static_cast<float>(step) * (2.0f / 3.0f) - 1.0f; }

/// Tries the first kind: 4x4 points over the ranges of the plane view.
void consider_across(const NormalValues& values, const PlaneView& view, NormalFit& best) {
  NormalFit start{};
  for (std::size_t i = 0; i < values.count; ++i) {
    start.cu[i] = coefficient(step_of(view.p[i], view.low_p, view.high_p, 3.0f));
    start.cv[i] = coefficient(step_of(view.q[i], view.low_q, view.high_q, 3.0f));
  }
  const RealGrid grid{view.center(), view.along * view.half_p(), view.across * view.half_q()};
  consider_grid(values, grid, start, 3, best);
}

/// Tries the second kind: all sixteen points along the first direction.
void consider_line(const NormalValues& values, const PlaneView& view, NormalFit& best) {
  NormalFit start{};
  for (std::size_t i = 0; i < values.count; ++i) {
    const int step = step_of(view.p[i], view.low_p, view.high_p, 15.0f);
    start.cu[i] = coefficient(step >> 2);
    start.cv[i] = coefficient(step & 3);
  }
  const RealGrid grid{view.center(), view.along * (0.8f * view.half_p()),
                      view.along * (0.2f * view.half_p())};
  consider_grid(values, grid, start, 3, best);
}

/// Tries the better of the first two kinds, or both if they are about equal. For a view of width p
/// and height q, their expected squared errors are (p² + q²) / 27 and q² / 3.
void consider_plane(const NormalValues& values, Vec3f mean, NormalFit& best) {
  const PlaneView view(values, mean);
  const float p = view.half_p(), q = view.half_q();
  if (q > 0.28f * p) consider_across(values, view, best);
  if (q < 0.42f * p) consider_line(values, view, best);
}

/// Three of the normals, each far from the previous ones.
struct FarNormals {
  Vec3f normal[3];

  explicit FarNormals(const NormalValues& values) {
    float distance[kValuesPerBlock];
    std::fill_n(distance, kValuesPerBlock, 8.0f);
    std::size_t next = 0;
    for (Vec3f& chosen : normal) {
      chosen = values.normal[next];
      for (std::size_t i = 0; i < values.count; ++i)
        distance[i] = std::min(distance[i], 1.0f - dot(values.normal[i], chosen));
      next =
          static_cast<std::size_t>(std::max_element(distance, distance + values.count) - distance);
    }
  }
};

/// Tries the third kind: three corners of the grid are at three directions that are far apart.
/// Tries each assignment.
void consider_corners(const NormalValues& values, NormalFit& best) {
  const FarNormals far(values);
  for (int shared = 0; shared < 3; ++shared) {
    const Vec3f d0 = far.normal[shared], d1 = far.normal[(shared + 1) % 3],
                d2 = far.normal[(shared + 2) % 3];
    const RealGrid grid{(d1 + d2) * 0.5f, (d1 - d0) * 0.5f, (d2 - d0) * 0.5f};
    if (longest_side(grid.base) > 0.25f) consider_grid(values, grid, 2, best);
  }
}

/// Tries a grid for normals and their opposites, as on both sides of a thin wall: three steps of u
/// give multiples of the base, and the fourth gives minus the base.
void consider_opposites(const NormalValues& values, NormalFit& best) {
  OuterProductSum spread;
  for (std::size_t i = 0; i < values.count; ++i) spread.add(values.normal[i], values.weight[i]);
  Vec3f axis = unit_vector(spread.principal_axis());
  float front = 0.0f, back = 0.0f;
  Vec3f front_sum, back_sum;
  for (std::size_t i = 0; i < values.count; ++i) {
    const float cosine = dot(values.normal[i], axis);
    if (std::fabs(cosine) < 0.4f) return;
    const Vec3f across = values.normal[i] * (1.0f / cosine) - axis;
    (cosine > 0.0f ? front : back) += values.weight[i];
    Vec3f& sum = cosine > 0.0f ? front_sum : back_sum;
    sum = sum + across * values.weight[i];
  }
  if (!(front > 0.0f && back > 0.0f)) return;
  // The side with more weight gets the three steps of one sign.
  if (front < back) {
    axis = -axis;
    std::swap(front, back);
    const Vec3f other = front_sum;
    front_sum = -back_sum;
    back_sum = -other;
  }
  const Vec3f in_front = front_sum * (1.0f / front), behind = back_sum * (1.0f / back);
  OuterProductSum across;
  float widest = 0.0f;
  for (std::size_t i = 0; i < values.count; ++i) {
    const float cosine = dot(values.normal[i], axis);
    const Vec3f from =
        values.normal[i] * (1.0f / cosine) - axis - (cosine > 0.0f ? in_front : behind);
    across.add(from, values.weight[i]);
    widest = std::max(widest, dot(from, from));
  }
  // The steps -1/3 (front) and 1 (back) of u then have the means of the two sides.
  const Vec3f base = axis + (in_front * 5.0f - behind) * 0.25f;
  const Vec3f u = axis * -2.0f - (behind + in_front * (5.0f / 3.0f)) * 0.75f;
  if (!(longest_side(base) > 0.25f)) return;
  // If the normals do not spread, v is free to correct u. Otherwise v takes the direction of the
  // spread.
  NormalFit start{};
  for (std::size_t i = 0; i < values.count; ++i) {
    const bool is_front = dot(values.normal[i], axis) > 0.0f;
    start.cu[i] = is_front ? -1.0f / 3.0f : 1.0f;
    start.cv[i] = is_front ? -1.0f : 1.0f;
  }
  consider_grid(values, {base, u, {}}, start, 2, best);
  if (widest > 1e-8f) {
    const Vec3f v = unit_vector(across.principal_axis()) * std::sqrt(widest);
    consider_grid(values, {base, u, v}, 2, best);
  }
}

/// Changes the integers of the axes by one while the error decreases.
void move_integers(const NormalValues& values, NormalFit& fit) {
  for (int round = 0; round < 3; ++round) {
    const float before = fit.error;
    for (int move = 0; move < 12; ++move) {
      NormalFit moved = fit;
      GridAxis& axis = move < 6 ? moved.u : moved.v;
      int& component = move % 3 == 0 ? axis.x : move % 3 == 1 ? axis.y : axis.z;
      component += move % 6 < 3 ? 1 : -1;
      if (component < -8 || component > 7) continue;
      const RealGrid grid = settled_grid(values, moved, moved.grid());
      if (is_lost(grid)) continue;
      moved.base = nearest_cube_point(grid.base);
      fit_points(values, moved);
      if (moved.error < fit.error) fit = moved;
    }
    if (!(fit.error < 0.95f * before)) return;
  }
}

/// Fits a single normal: stores the base, and an axis from the base to the normal.
NormalFit fit_one_normal(Vec3f normal) {
  NormalValues values;
  values.count = 1;
  values.normal[0] = normal;
  values.x[0] = normal.x, values.y[0] = normal.y, values.z[0] = normal.z;
  values.weight[0] = values.total_weight = 1.0f;
  NormalFit plain;
  plain.base = nearest_cube_point(normal);
  fit_points(values, plain);
  NormalFit fit = plain;
  // The point to which both axes are added; one of them is zero.
  const Vec3f base = plain.base.position();
  fit.u = nearest_axis(normal * dot(normal, base) - base, normal, 0.0f);
  fit_points(values, fit);
  return fit.error < plain.error ? fit : plain;
}

/// Returns the block of a single normal from a cache: flat surfaces repeat few normals.
const NormalFit& one_normal(Vec3f normal) {
  // Compares bits: if 0 and -0 counted as equal, results would depend on the thread's earlier
  // calls.
  using Bits = std::array<std::uint32_t, 3>;
  struct Known {
    Bits normal{};  // Zero marks an empty entry: it is no unit vector.
    NormalFit fit;
  };
  constexpr int kLog2Known = 6;
  thread_local std::array<Known, 1u << kLog2Known> all;
  const Bits bits{bits_of_float(normal.x), bits_of_float(normal.y), bits_of_float(normal.z)};
  const std::uint32_t hash = bits[0] * 31 + bits[1] * 17 + bits[2];
  Known& known = all[hash * 2654435761u >> (32 - kLog2Known)];
  if (known.normal != bits) known = {bits, fit_one_normal(normal)};
  return known.fit;
}

NormalFit fit_grid(const NormalValues& values) {
  if (values.count == 1) return one_normal(values.normal[0]);
  NormalFit best;
  best.base = nearest_cube_point(values.normal[0]);
  fit_points(values, best);

  Vec3f middle;
  for (std::size_t i = 0; i < values.count; ++i)
    middle = middle + values.normal[i] * values.weight[i];
  if (dot(middle, middle) > 0.01f * values.total_weight * values.total_weight) {
    middle = unit_vector(middle);
    float least = 1.0f;
    for (std::size_t i = 0; i < values.count; ++i)
      least = std::min(least, dot(values.normal[i], middle));
    if (least > 0.2f) consider_plane(values, middle, best);
  }
  if (best.error < kHard * values.total_weight) return best;
  consider_corners(values, best);
  if (best.error < kGood * values.total_weight) return best;
  consider_opposites(values, best);
  if (best.error < kGood * values.total_weight) return best;
  move_integers(values, best);
  return best;
}

}  // namespace

NormalBlock encode_normal_block(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                                const float* weights) {
  NormalValues values;
  gather_normals(normals, used, weights, values);
  if (values.count == 0) return {};
  const NormalFit fit = fit_grid(values);
  const auto step = [](float coefficient) {
    return static_cast<std::uint32_t>(coefficient * 1.5f + 2.0f);
  };
  std::uint32_t u_steps = 0, v_steps = 0;
  for (int i = 0; i < kValuesPerBlock; ++i)
    if ((values.used >> i & 1u) != 0) {
      u_steps |= step(fit.cu[values.of_slot[i]]) << (2 * i);
      v_steps |= step(fit.cv[values.of_slot[i]]) << (2 * i);
    }
  return NormalBlock::pack(fit.base, fit.u, fit.v, u_steps, v_steps);
}

}  // namespace voxdag
