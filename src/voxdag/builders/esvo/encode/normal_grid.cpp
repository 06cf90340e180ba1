#include "voxdag/builders/esvo/encode/normal_grid.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

/// Normals are merged if their components differ by less than this: about 0.0003 degrees.
constexpr float kSame = 4e-6f;
constexpr float kThird = 1.0f / 3.0f;
constexpr float kCoefficients[4] = {-1.0f, -kThird, kThird, 1.0f};
constexpr FloatLanes kCoefficientLanes = {-1.0f, -kThird, kThird, 1.0f};

FloatLanes square_root(FloatLanes v) {
  for (int lane = 0; lane < kLanes; ++lane) v[lane] = std::sqrt(v[lane]);
  return v;
}

/// Rounds to the nearest integer within [-8, 7].
FloatLanes nearest_component(FloatLanes v) {
  return truncated(min(max(v, all_lanes(-8.0f)), all_lanes(7.0f)) + 8.5f) - 8.0f;
}

/// The directions of a grid's points, relative to its base, and half of their squares. The four
/// points of a u step are the lanes.
struct GridDirections {
  FloatLanes x[4], y[4], z[4], half_square[4];
  Vec3f base;

  explicit GridDirections(const RealGrid& grid) : base(unit_vector(grid.base)) {
    const FloatLanes vx = kCoefficientLanes * grid.v.x, vy = kCoefficientLanes * grid.v.y,
                     vz = kCoefficientLanes * grid.v.z;
    for (int row = 0; row < 4; ++row) {
      const Vec3f start = grid.base + grid.u * kCoefficients[row];
      const FloatLanes px = vx + start.x, py = vy + start.y, pz = vz + start.z;
      const FloatLanes squared = px * px + py * py + pz * pz;
      // A point without a direction is placed so far away that it is never chosen.
      const IntLanes directed = squared > 1e-6f;
      const FloatLanes scale = 1.0f / square_root(directed ? squared : all_lanes(1.0f));
      x[row] = px * scale - base.x, y[row] = py * scale - base.y, z[row] = pz * scale - base.z;
      const FloatLanes square = x[row] * x[row] + y[row] * y[row] + z[row] * z[row];
      half_square[row] = directed ? square * 0.5f : all_lanes(1e6f);
    }
  }
};

/// Assigns points to 4 * `Groups` normals. Compares squared chords without the terms that all
/// points share.
template <int Groups>
void fit_groups(const NormalValues& values, const GridDirections& points, NormalFit& fit) {
  FloatLanes x[Groups], y[Groups], z[Groups], least[Groups], nearest[Groups];
  for (int g = 0; g < Groups; ++g) {
    x[g] = load_lanes(&values.x[g * kLanes]) - points.base.x;
    y[g] = load_lanes(&values.y[g * kLanes]) - points.base.y;
    z[g] = load_lanes(&values.z[g * kLanes]) - points.base.z;
    least[g] = all_lanes(INFINITY);
    nearest[g] = all_lanes(0.0f);
  }
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const float px = points.x[row][column], py = points.y[row][column],
                  pz = points.z[row][column], half_square = points.half_square[row][column];
      const FloatLanes point = all_lanes(static_cast<float>(4 * row + column));
      for (int g = 0; g < Groups; ++g) {
        const FloatLanes half = half_square - (x[g] * px + y[g] * py + z[g] * pz);
        const IntLanes nearer = half < least[g];
        least[g] = nearer ? half : least[g];
        nearest[g] = nearer ? point : nearest[g];
      }
    }
  FloatLanes error = {};
  for (int g = 0; g < Groups; ++g) {
    const FloatLanes squared = x[g] * x[g] + y[g] * y[g] + z[g] * z[g] + least[g] * 2.0f;
    error += max(squared, all_lanes(0.0f)) * load_lanes(&values.weight[g * kLanes]);
    const FloatLanes row = truncated(nearest[g] * 0.25f);
    const FloatLanes cu = row * (2.0f * kThird) - 1.0f;
    const FloatLanes cv = (nearest[g] - row * 4.0f) * (2.0f * kThird) - 1.0f;
    std::memcpy(&fit.cu[g * kLanes], &cu, sizeof cu);
    std::memcpy(&fit.cv[g * kLanes], &cv, sizeof cv);
  }
  fit.error = error[0] + error[1] + error[2] + error[3];
}

int nearest_int(float v) { return static_cast<int>(v + 32768.5f) - 32768; }

}  // namespace

float longest_side(Vec3f v) {
  return std::max(std::fabs(v.x), std::max(std::fabs(v.y), std::fabs(v.z)));
}

void gather_normals(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                    const float* weights, NormalValues& values) {
  for (int i = 0; i < kValuesPerBlock; ++i) {
    if ((used >> i & 1u) == 0) continue;
    Vec3f normal = normals[static_cast<std::size_t>(i)];
    const float longest = longest_side(normal);
    if (!(longest > 1e-30f && longest < 1e30f && dot(normal, normal) == dot(normal, normal)))
      continue;
    normal = unit_vector(normal * (1.0f / longest));
    std::size_t k = 0;
    while (k < values.count && longest_side(values.normal[k] - normal) > kSame) ++k;
    if (k == values.count) {
      ++values.count;
      values.normal[k] = normal;
      values.x[k] = normal.x, values.y[k] = normal.y, values.z[k] = normal.z;
    }
    const float weight = weights != nullptr ? weights[i] : 1.0f;
    values.used |= 1u << i;
    values.of_slot[i] = k;
    values.weight[k] += weight;
    values.total_weight += weight;
  }
}

void fit_points(const NormalValues& values, NormalFit& fit) {
  const GridDirections points(fit.grid());
  if (values.count <= 4) return fit_groups<1>(values, points, fit);
  if (values.count <= 8) return fit_groups<2>(values, points, fit);
  if (values.count <= 12) return fit_groups<3>(values, points, fit);
  fit_groups<4>(values, points, fit);
}

CubePoint nearest_cube_point(Vec3f direction) {
  const Vec3f size{std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)};
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const Vec3f p = direction * (1.0f / size[axis]);
  const float pu = axis == 0 ? p.y : axis == 1 ? p.z : p.x;
  const float pv = axis == 0 ? p.z : axis == 1 ? p.x : p.y;
  return {2 * axis + (p[axis] < 0.0f ? 1 : 0), nearest_int(pu * 16383.0f) + 16384,
          nearest_int(pv * 8191.0f) + 8192};
}

GridAxis nearest_axis(Vec3f target, Vec3f base, float bend) {
  // Chooses the finest unit in which no component exceeds 7.45.
  const std::uint32_t bits = bits_of_float(longest_side(target) * (1.0f / 7.45f));
  const int ceiling = static_cast<int>(bits >> 23) - 127 + ((bits & 0x7FFFFFu) != 0 ? 1 : 0);
  const int exponent = std::min(std::max(ceiling + GridAxis::kBias, 0), 15);
  const Vec3f t = target * (1.0f / GridAxis::scale(exponent));

  // One component takes each of its sixteen values in turn, by adding a multiple of the base; the
  // other components get the same multiple before they are rounded.
  const Vec3f size{std::fabs(base.x), std::fabs(base.y), std::fabs(base.z)};
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  FloatLanes least = all_lanes(INFINITY), best_x = {}, best_y = {}, best_z = {};
  const float per_step = 1.0f / base[axis];
  for (int first = -8; first < 8; first += kLanes) {
    const FloatLanes step = FloatLanes{0.0f, 1.0f, 2.0f, 3.0f} + static_cast<float>(first);
    const FloatLanes along = (step - t[axis]) * per_step;
    const FloatLanes x = nearest_component(along * base.x + t.x),
                     y = nearest_component(along * base.y + t.y),
                     z = nearest_component(along * base.z + t.z);
    const FloatLanes dx = x - t.x, dy = y - t.y, dz = z - t.z;
    const FloatLanes lengthwise = dx * base.x + dy * base.y + dz * base.z;
    const FloatLanes cost = dx * dx + dy * dy + dz * dz - lengthwise * lengthwise * (1.0f - bend);
    const IntLanes better = cost < least;
    least = better ? cost : least;
    best_x = better ? x : best_x;
    best_y = better ? y : best_y;
    best_z = better ? z : best_z;
  }
  int lane = 0;
  for (int i = 1; i < kLanes; ++i)
    if (least[i] < least[lane]) lane = i;
  return {static_cast<int>(best_x[lane]), static_cast<int>(best_y[lane]),
          static_cast<int>(best_z[lane]), exponent};
}

}  // namespace voxdag
