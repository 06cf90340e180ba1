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

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using DU = hn::RebindToUnsigned<D>;
using DI = hn::RebindToSigned<D>;  // Sums are below 2^63.
using V = hn::Vec<D>;
constexpr int kSide = SplatBrick::kSide;

/// Returns exp(-squared / 2) for squared from 0 to 9, with a relative error below 4e-10: the
/// polynomial is that of exp(-squared / 16).
HWY_ATTR V gaussian(V squared) {
  const D d;
  const V t = hn::Mul(squared, hn::Set(d, -0.0625));
  V p = hn::Set(d, 0.0001555009205924119);
  for (const double next : {0.0013571251586455074, 0.008321406182960728, 0.041664345801272956,
                            0.16666645052550583, 0.49999999242658427, 0.9999999999565584, 1.0})
    p = hn::Add(hn::Mul(p, t), hn::Set(d, next));
  p = hn::Mul(p, p);
  p = hn::Mul(p, p);
  return hn::Mul(p, p);
}

HWY_ATTR V sum_of_products(const V (&a)[3], const V (&b)[3]) {
  return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

HWY_ATTR std::uint32_t bits_of(hn::Mask<DI> mask) {
#if HWY_TARGET == HWY_WASM  // Highway 1.0 takes the lanes one by one.
  return wasm_i64x2_bitmask(mask.raw);
#else
  std::uint8_t bytes[8];
  hn::StoreMaskBits(DI(), mask, bytes);
  return bytes[0];
#endif
}

/// A splat in a brick.
class RowAdder {
 public:
  HWY_ATTR RowAdder(const SplatRows& rows, const GridSplat& splat) : rows_(rows), splat_(splat) {
    for (int axis = 0; axis < 3; ++axis) {
      lo_[axis] = std::max(splat.box.lo[axis] - rows.first[axis], 0);
      hi_[axis] = std::min(splat.box.hi[axis] - rows.first[axis], kSide);
    }
  }

  HWY_ATTR void add() const {
    const D d;
    V mx[3];
    for (std::size_t k = 0; k < 3; ++k) mx[k] = hn::Set(d, splat_.rows[k].x);
    const V a = sum_of_products(mx, mx);
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int z = lo_.z; z < hi_.z; ++z)
      for (int y = lo_.y; y < hi_.y; y += lanes) add_rows(mx, a, y, z);
  }

 private:
  /// The first and the last place of a row that the splat may reach.
  struct Spans {
    HWY_ALIGN double from[hn::MaxLanes(D())], to[hn::MaxLanes(D())];
  };

  /// Adds to the rows from y on, one for each lane.
  HWY_ATTR void add_rows(const V (&mx)[3], V a, int y, int z) const {
    const int count = std::min(static_cast<int>(hn::Lanes(D())), hi_.y - y);
    const D d;
    const V dy =
        hn::Sub(hn::Iota(d, static_cast<double>(rows_.first.y + y)), hn::Set(d, splat_.center.y));
    const double dz = (rows_.first.z + z) - splat_.center.z;
    double mz[3];
    V my[3], across[3];
    for (std::size_t k = 0; k < 3; ++k) {
      mz[k] = splat_.rows[k].z * dz;
      my[k] = hn::Mul(hn::Set(d, splat_.rows[k].y), dy);
      across[k] = hn::Add(my[k], hn::Set(d, mz[k]));
    }
    // A little more than the reach: the loop over the voxels decides.
    constexpr double kLimit = kSplatReach * kSplatReach + 0.01;
    const V b = sum_of_products(mx, across);
    const V c = hn::Sub(sum_of_products(across, across), hn::Set(d, kLimit));
    const V discriminant = hn::Sub(hn::Mul(b, b), hn::Mul(a, c));
    const auto reaches = hn::Ge(discriminant, hn::Zero(d));
    if (hn::AllFalse(d, reaches)) return;
    const V root = hn::Sqrt(hn::Max(discriminant, hn::Zero(d))),
            inverse = hn::Div(hn::Set(d, 1.0), a), half = hn::Mul(root, inverse),
            middle = hn::NegMulAdd(b, inverse, hn::Set(d, splat_.center.x - rows_.first.x));
    Spans spans;
    hn::Store(hn::Ceil(hn::Sub(middle, half)), d, spans.from);
    hn::Store(hn::IfThenElse(reaches, hn::Floor(hn::Add(middle, half)), hn::Set(d, -1.0)), d,
              spans.to);
    HWY_ALIGN double all_my[3][hn::MaxLanes(D())];
    for (std::size_t k = 0; k < 3; ++k) hn::Store(my[k], d, all_my[k]);
    for (int i = 0; i < count; ++i) {
      if (!(spans.from[i] < hi_.x && spans.to[i] >= lo_.x)) continue;
      const double row_my[3] = {all_my[0][i], all_my[1][i], all_my[2][i]};
      add_row(mx, row_my, mz, y + i, z, static_cast<int>(std::max<double>(spans.from[i], lo_.x)),
              static_cast<int>(std::min<double>(spans.to[i], hi_.x - 1)) + 1);
    }
  }

  /// Adds to the voxels [begin, end) of a row. Lanes beyond `end` add nothing.
  HWY_ATTR void add_row(const V (&mx)[3], const double (&my)[3], const double (&mz)[3], int y,
                        int z, int begin, int end) const {
    const D d;
    const DU du;
    const DI di;
    const auto below = static_cast<std::int64_t>(rows_.least) - 1;
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
    const V limit = hn::Set(d, kSplatReach * kSplatReach),
            extinction = hn::Set(d, splat_.extinction),
            past = hn::Set(d, static_cast<double>(rows_.first.x + end)),
            center_x = hn::Set(d, splat_.center.x), one = hn::Set(d, 0x1p52);
    const V my0 = hn::Set(d, my[0]), my1 = hn::Set(d, my[1]), my2 = hn::Set(d, my[2]);
    const V mz0 = hn::Set(d, mz[0]), mz1 = hn::Set(d, mz[1]), mz2 = hn::Set(d, mz[2]);
    for (int x = begin; x < end; x += static_cast<int>(hn::Lanes(d))) {
      const V place = hn::Iota(d, static_cast<double>(rows_.first.x + x));
      const V dx = hn::Sub(place, center_x);
      const V u[3] = {hn::Add(hn::Add(hn::Mul(mx[0], dx), my0), mz0),
                      hn::Add(hn::Add(hn::Mul(mx[1], dx), my1), mz1),
                      hn::Add(hn::Add(hn::Mul(mx[2], dx), my2), mz2)};
      const V squared = sum_of_products(u, u);
      const auto is_reached = hn::And(hn::Le(squared, limit), hn::Lt(place, past));
      const V term = hn::IfThenElseZero(is_reached, hn::Mul(extinction, gaussian(squared)));
      // Below 2^52, this rounds to the nearest whole number, to an even one in the middle.
      const auto whole = hn::Sub(hn::BitCast(du, hn::Add(term, one)), hn::BitCast(du, one));
      const auto sum = hn::Add(hn::LoadU(du, sums + x), whole);
      hn::StoreU(sum, du, sums + x);
      set |= bits_of(hn::Gt(hn::BitCast(di, sum), hn::Set(di, below))) << x;
      if (weights == nullptr) continue;
      const auto weight = hn::ShiftRight<12>(hn::Add(whole, hn::Set(du, 4095)));
      const auto add = [&](int channel, auto value) HWY_ATTR {
        std::uint64_t* const at = weights + channel * kSide + x;
        hn::StoreU(hn::Add(hn::LoadU(du, at), value), du, at);
      };
      add(0, weight);
      // Products are whole numbers below 2^52, which doubles hold.
      const V factor = hn::Sub(hn::BitCast(d, hn::Add(weight, hn::BitCast(du, one))), one);
      for (std::size_t i = 0; i < 3; ++i) {
        const V product = hn::Mul(factor, hn::Set(d, static_cast<double>(splat_.color[i])));
        add(static_cast<int>(i) + 1,
            hn::Sub(hn::BitCast(du, hn::Add(product, one)), hn::BitCast(du, one)));
      }
    }
  }

  const SplatRows& rows_;
  const GridSplat& splat_;
  Vec3i lo_{}, hi_{};  ///< The voxels of the brick in the splat's box.
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
