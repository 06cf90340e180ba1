// Sums the extinction of splats. Compiled once for each instruction set; the best that the machine
// has is chosen at run time. All of them do the same arithmetic on doubles, one operation at a
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/builders/splats/splat_rows.cpp"
#include "voxdag/builders/splats/splat_rows.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxdag/builders/splats/splat_brick.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {
namespace {

constexpr int kSide = SplatBrick::kSide;

/// Returns exp(-squared / 2) for squared from 0 to 9, with a relative error below 4e-10: the
/// polynomial is that of exp(-squared / 16).
HWY_ATTR inline double gaussian(double squared) {
  const double t = squared * -0.0625;
  double p = 0.0001555009205924119;
  p = p * t + 0.0013571251586455074;
  p = p * t + 0.008321406182960728;
  p = p * t + 0.041664345801272956;
  p = p * t + 0.16666645052550583;
  p = p * t + 0.49999999242658427;
  p = p * t + 0.9999999999565584;
  p = p * t + 1;
  p = p * p;
  p = p * p;
  return p * p;
}

/// The voxels [begin, end) of a row that a splat may reach.
struct Span {
  int begin, end;
};

/// Returns the voxels [begin, end) of a row, within [lo, hi), that the splat may reach. `across` is
/// u of the place in the row that is beside the centre.
HWY_ATTR inline Span span_of(const GridSplat& splat, const double (&across)[3], int first_x, int lo,
                             int hi) {
  // A little more than the reach: the loop over the voxels decides.
  constexpr double kLimit = kSplatReach * kSplatReach + 0.01;
  double a = 0, b = 0, c = -kLimit;
  for (std::size_t k = 0; k < 3; ++k) {
    a += splat.rows[k].x * splat.rows[k].x;
    b += splat.rows[k].x * across[k];
    c += across[k] * across[k];
  }
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return {0, 0};
  const double root = std::sqrt(discriminant);
  const double middle = splat.center.x - first_x;
  const double from = std::ceil(middle + (-b - root) / a),
               to = std::floor(middle + (-b + root) / a);
  if (!(from < hi && to >= lo)) return {0, 0};
  return {static_cast<int>(std::max<double>(from, lo)),
          static_cast<int>(std::min<double>(to, hi - 1)) + 1};
}

}  // namespace

HWY_ATTR void add_splat_rows(const SplatRows& rows, const GridSplat& splat) {
  const Vec3i first = rows.first;
  Vec3i lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    lo[axis] = std::max(splat.box.lo[axis] - first[axis], 0);
    hi[axis] = std::min(splat.box.hi[axis] - first[axis], kSide);
  }
  const double mx0 = splat.rows[0].x, mx1 = splat.rows[1].x, mx2 = splat.rows[2].x;
  const double center_x = splat.center.x, extinction = splat.extinction;
  const std::uint32_t red = splat.color[0], green = splat.color[1], blue = splat.color[2];
  for (int z = lo.z; z < hi.z; ++z) {
    const double dz = (first.z + z) - splat.center.z;
    for (int y = lo.y; y < hi.y; ++y) {
      const double dy = (first.y + y) - splat.center.y;
      double my[3], mz[3], across[3];
      for (std::size_t k = 0; k < 3; ++k) {
        my[k] = splat.rows[k].y * dy;
        mz[k] = splat.rows[k].z * dz;
        across[k] = my[k] + mz[k];
      }
      const Span span = span_of(splat, across, first.x, lo.x, hi.x);
      if (span.begin >= span.end) continue;
      const std::size_t row = static_cast<std::size_t>(z * kSide + y) * kSide;
      std::uint64_t* const sums = rows.sums + row;
      if ((rows.touched[z] >> y & 1) == 0) {
        rows.touched[z] |= 1u << y;
        std::fill(sums, sums + kSide, 0);
        if (rows.colors != nullptr) std::fill_n(rows.colors + 4 * row, 4 * kSide, 0);
      }
      std::uint64_t terms[kSide];
      for (int x = span.begin; x < span.end; ++x) {
        const double dx = (first.x + x) - center_x;
        const double u0 = (mx0 * dx + my[0]) + mz[0];
        const double u1 = (mx1 * dx + my[1]) + mz[1];
        const double u2 = (mx2 * dx + my[2]) + mz[2];
        const double squared = (u0 * u0 + u1 * u1) + u2 * u2;
        const double term =
            squared <= kSplatReach * kSplatReach ? extinction * gaussian(squared) : 0.0;
        // Below 2^52, this rounds to the nearest whole number, to an even one in the middle.
        terms[x] =
            std::bit_cast<std::uint64_t>(term + 0x1p52) - std::bit_cast<std::uint64_t>(0x1p52);
        sums[x] += terms[x];
      }
      if (rows.colors == nullptr) continue;
      std::uint64_t* const weights = rows.colors + 4 * row;
      for (int x = span.begin; x < span.end; ++x) {
        const std::uint64_t weight = static_cast<std::uint32_t>((terms[x] + 4095) >> 12);
        weights[x] += weight;
        weights[x + kSide] += weight * red;
        weights[x + 2 * kSide] += weight * green;
        weights[x + 3 * kSide] += weight * blue;
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(add_splat_rows);

void add_splat(const SplatRows& rows, const GridSplat& splat) {
  HWY_DYNAMIC_DISPATCH(add_splat_rows)(rows, splat);
}

void SplatBrick::add(const GridSplat& splat) {
  add_splat({first_, touched_.data(), sums_.data(), colors_.empty() ? nullptr : colors_.data()},
            splat);
}

}  // namespace voxdag
#endif
