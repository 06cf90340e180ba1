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
#include <cstring>

#include "voxdag/builders/splats/splat_brick.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {
namespace {

// Vectors of the compilers: Highway 1.0 has no doubles in WebAssembly.
constexpr int kLanes = std::max(
    2, static_cast<int>(hwy::HWY_NAMESPACE::MaxLanes(hwy::HWY_NAMESPACE::ScalableTag<double>())));
using V = double __attribute__((vector_size(8 * kLanes)));
using U = std::uint64_t __attribute__((vector_size(8 * kLanes)));
using I = std::int64_t __attribute__((vector_size(8 * kLanes)));
constexpr int kSide = SplatBrick::kSide;

/// Returns exp(-squared / 2) for squared from 0 to 9, with a relative error below 4e-10: the
/// polynomial is that of exp(-squared / 16).
HWY_ATTR inline V gaussian(V squared) {
  const V t = squared * -0.0625;
  V p = t * 0.0001555009205924119 + 0.0013571251586455074;
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

/// Returns first, first + 1, ...
HWY_ATTR inline V count_from(double first) {
  V lanes{};
  for (int i = 0; i < kLanes; ++i) lanes[i] = i;
  return first + lanes;
}

/// Rounds numbers from 0 to 2^52 to whole numbers, from the middle to an even one.
HWY_ATTR inline U whole_of(V value) { return (U)(value + 0x1p52) - (U)(V{} + 0x1p52); }

/// Returns the sums.
HWY_ATTR inline U add_to(std::uint64_t* at, U value) {
  U sum;
  std::memcpy(&sum, at, sizeof sum);
  sum += value;
  std::memcpy(at, &sum, sizeof sum);
  return sum;
}

/// A splat in a brick.
class RowAdder {
 public:
  HWY_ATTR RowAdder(const SplatRows& rows, const GridSplat& splat) : rows_(rows), splat_(splat) {
    for (int axis = 0; axis < 3; ++axis) {
      lo_[axis] = std::max(splat.box.lo[axis] - rows.first[axis], 0);
      hi_[axis] = std::min(splat.box.hi[axis] - rows.first[axis], kSide);
    }
    for (const Vec3d& row : splat.rows) a_ += row.x * row.x;
  }

  HWY_ATTR void add() const {
    for (int z = lo_.z; z < hi_.z; ++z)
      for (int y = lo_.y; y < hi_.y; y += kLanes) add_rows(y, z);
  }

 private:
  /// Adds to the rows from y on, one for each lane.
  HWY_ATTR void add_rows(int y, int z) const {
    const V dy = count_from(rows_.first.y + y) - splat_.center.y;
    const double dz = (rows_.first.z + z) - splat_.center.z;
    // A little more than the reach: the loop over the voxels decides.
    constexpr double kLimit = kSplatReach * kSplatReach + 0.01;
    V my[3], b{}, c = V{} - kLimit;
    double mz[3];
    for (std::size_t k = 0; k < 3; ++k) {
      mz[k] = splat_.rows[k].z * dz;
      my[k] = splat_.rows[k].y * dy;
      const V across = my[k] + mz[k];
      b += splat_.rows[k].x * across;
      c += across * across;
    }
    const V discriminant = b * b - a_ * c;
    const double inverse = 1 / a_, middle = splat_.center.x - rows_.first.x;
    for (int i = 0; i < std::min(kLanes, hi_.y - y); ++i) {
      if (!(discriminant[i] >= 0)) continue;
      const double half = std::sqrt(discriminant[i]) * inverse, at = middle - b[i] * inverse;
      const double from = std::ceil(at - half), to = std::floor(at + half);
      if (!(from < hi_.x && to >= lo_.x)) continue;
      add_row({my[0][i], my[1][i], my[2][i]}, {mz[0], mz[1], mz[2]}, y + i, z,
              static_cast<int>(std::max<double>(from, lo_.x)),
              static_cast<int>(std::min<double>(to, hi_.x - 1)) + 1);
    }
  }

  /// Adds to the voxels [begin, end) of a row. Lanes beyond `end` add nothing.
  HWY_ATTR void add_row(Vec3d my, Vec3d mz, int y, int z, int begin, int end) const {
    const std::size_t row = static_cast<std::size_t>(z * kSide + y) * kSide;
    std::uint64_t* const sums = rows_.sums + row;
    std::uint64_t* const weights = rows_.colors == nullptr ? nullptr : rows_.colors + 4 * row;
    std::uint32_t& set = rows_.set[z * kSide + y];
    if ((rows_.touched[z] >> y & 1) == 0) {
      rows_.touched[z] |= 1u << y;
      set = 0;
      std::fill(sums, sums + kSide, 0);
      if (weights != nullptr) std::fill_n(weights, 4 * kSide, 0);
    } else if (weights == nullptr) {
      // More extinction does not change a voxel that is set.
      const std::uint32_t left = ~set & ~0u << begin & ~0u >> (kSide - end);
      if (left == 0) return;
      begin = std::countr_zero(left);
      end = kSide - std::countl_zero(left);
    }
    const double past = rows_.first.x + end;
    const Vec3d mx{splat_.rows[0].x, splat_.rows[1].x, splat_.rows[2].x};
    U bit{}, found{};
    for (int i = 0; i < kLanes; ++i) bit[i] = std::uint64_t{1} << i;
    for (int x = begin; x < end; x += kLanes) {
      const V place = count_from(rows_.first.x + x), dx = place - splat_.center.x;
      const V u0 = (mx.x * dx + my.x) + mz.x, u1 = (mx.y * dx + my.y) + mz.y,
              u2 = (mx.z * dx + my.z) + mz.z;
      const V squared = (u0 * u0 + u1 * u1) + u2 * u2;
      const I reached = (squared <= kSplatReach * kSplatReach) & (place < past);
      const U whole = whole_of(splat_.extinction * gaussian(squared)) & (U)reached;
      const U sum = add_to(sums + x, whole);
      found |= (U)(sum >= rows_.least) & (bit << x);
      if (weights == nullptr) continue;
      const U weight = (whole + 4095) >> 12;
      add_to(weights + x, weight);
      // Products are whole numbers below 2^52, which doubles hold.
      const V factor = (V)(weight + (U)(V{} + 0x1p52)) - 0x1p52;
      for (int i = 0; i < 3; ++i)
        add_to(weights + (i + 1) * kSide + x,
               whole_of(factor * static_cast<double>(splat_.color[static_cast<std::size_t>(i)])));
    }
    for (int i = 0; i < kLanes; ++i) set |= static_cast<std::uint32_t>(found[i]);
  }

  const SplatRows& rows_;
  const GridSplat& splat_;
  Vec3i lo_{}, hi_{};  ///< The voxels of the brick in the splat's box.
  double a_ = 0;       ///< Of d² = a x² + ... along a row.
};

}  // namespace

HWY_ATTR void add_splat_rows(const SplatRows& rows, const GridSplat& splat) {
  RowAdder(rows, splat).add();
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
  add_splat({first_, touched_.data(), set_.data(), sums_.data(),
             colors_.empty() ? nullptr : colors_.data(), least_},
            splat);
}

}  // namespace voxdag
#endif
