#include "voxdag/attributes/fit_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxdag {
namespace {

/// A table: the field of 5 to 8 bits that stands for the value nearest to each value of 8 bits.
class NearestFields {
 public:
  NearestFields() {
    for (int bits = 5; bits <= 8; ++bits)
      for (int value = 0; value < 256; ++value) {
        int best = 0;
        for (int field = 0; field < 1 << bits; ++field)
          if (distance(field, bits, value) < distance(best, bits, value)) best = field;
        table_[static_cast<std::size_t>(bits - 5)][static_cast<std::size_t>(value)] =
            static_cast<std::uint8_t>(best);
      }
  }
  std::uint32_t operator()(int bits, int value) const {
    return table_[static_cast<std::size_t>(bits - 5)][static_cast<std::size_t>(value)];
  }

 private:
  static int distance(int field, int bits, int value) {
    return std::abs((field << (8 - bits) | field >> (2 * bits - 8)) - value);
  }
  std::array<std::array<std::uint8_t, 256>, 4> table_;
};

std::uint8_t to_byte(float v) {
  return static_cast<std::uint8_t>(std::clamp(v + 0.5f, 0.0f, 255.0f));
}

}  // namespace

/// Consecutive values of a page.
struct BlockFitter::Run {
  int begin, end;
  Value8 lo, hi;  // the smallest and the largest value of each channel
  float mean[3];

  int count() const { return end - begin; }
};

BlockFitter::BlockFitter(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
                         EndPrecision precision)
    : values_(values), metric_(metric), precision_(precision) {}

std::uint32_t BlockFitter::pack(Value8 value) const {
  static const NearestFields nearest;
  std::uint32_t end = 0;
  for (int c = 2; c >= 0; --c) {
    const int bits = precision_.channel_bits(c);
    end = end << bits | nearest(bits, value[c]);
  }
  return end;
}

BlockFitter::Line BlockFitter::line_of(const FittedBlock& fitted) const {
  const Value8 e0 = precision_.unpack(fitted.e0);
  const Value8 e1 = fitted.block.has_step() ? stepped_end(e0, static_cast<int>(fitted.second))
                                            : precision_.unpack(fitted.second);
  Line line;
  line.most = (1 << fitted.block.weight_bits()) - 1;
  for (int k = 0; k <= line.most; ++k) line.palette[k] = mix_ends(e0, e1, k, line.most);
  float length2 = 0;
  for (int c = 0; c < 3; ++c) {
    const auto d = static_cast<float>(e1[c] - e0[c]);
    line.along[c] = static_cast<float>(metric_.weights[static_cast<std::size_t>(c)]) * d;
    length2 += line.along[c] * d;
  }
  line.offset = 0.5f;
  if (!(length2 > 0)) return line;
  for (int c = 0; c < 3; ++c) {
    line.along[c] *= static_cast<float>(line.most) / length2;
    line.offset -= line.along[c] * static_cast<float>(e0[c]);
  }
  return line;
}

bool BlockFitter::keeps_bound(const FittedBlock& fitted) const {
  const Line line = line_of(fitted);
  for (int i = fitted.begin; i < fitted.end(); ++i) {
    const Value8 value = values_[static_cast<std::size_t>(i)];
    if (metric_.error(value, line.palette[line.nearest(value)]) > metric_.bound) return false;
  }
  return true;
}

bool BlockFitter::fit_flat(const Run& run, FittedBlock& fitted) const {
  Value8 centre{};
  for (int c = 0; c < 3; ++c) {
    const int extent = run.hi[c] - run.lo[c];
    if (metric_.weights[static_cast<std::size_t>(c)] * (extent / 2) * (extent / 2) > metric_.bound)
      return false;
    centre[c] = static_cast<std::uint8_t>((run.lo[c] + run.hi[c] + 1) / 2);
  }
  fitted.block.type = ValueBlock::kFlat;
  fitted.e0 = pack(centre);
  const Value8 stored = precision_.unpack(fitted.e0);
  for (int i = run.begin; i < run.end; ++i)
    if (metric_.error(values_[static_cast<std::size_t>(i)], stored) > metric_.bound) return false;
  fitted.bits = fitted.block.bits(precision_.bits());
  return true;
}

/// Replaces `best` by `candidate`, whose ends are set, if that keeps the bound in fewer bits. Takes
/// the type, `first_type` to `last_type`, with the fewest bits of a weight. `off_line` is the
/// largest squared distance of a value from the line, and `range` the extent of the values along
/// it. Both scale each channel by the root of its weight.
void BlockFitter::try_line(const Run& run, FittedBlock candidate, int first_type, int last_type,
                           float range, float off_line, FittedBlock& best) const {
  const float left = static_cast<float>(metric_.bound) - off_line;
  if (left <= 0) return;
  candidate.block.length = run.count();
  for (int type = first_type; type <= last_type; ++type) {
    candidate.block.type = type;
    candidate.bits = candidate.block.bits(precision_.bits());
    if (candidate.bits >= best.bits) return;
    const float steps = static_cast<float>((2 << candidate.block.weight_bits()) - 2);
    if (range * range > left * steps * steps || !keeps_bound(candidate)) continue;
    best = candidate;
    return;
  }
}

void BlockFitter::fit_grey(const Run& run, FittedBlock& best) const {
  float share[3], mean = 0;
  for (int c = 0; c < 3; ++c) {
    share[c] = static_cast<float>(metric_.weights[static_cast<std::size_t>(c)]) /
               static_cast<float>(metric_.sum());
    mean += share[c] * run.mean[c];
  }
  float lo = 255, hi = 0, off_line = 0;
  for (int i = run.begin; i < run.end; ++i) {
    const Value8 v = values_[static_cast<std::size_t>(i)];
    const float d[3] = {v.x - run.mean[0], v.y - run.mean[1], v.z - run.mean[2]};
    const float along = share[0] * d[0] + share[1] * d[1] + share[2] * d[2];
    lo = std::min(lo, along);
    hi = std::max(hi, along);
    float off = 0;
    for (int c = 0; c < 3; ++c) off += share[c] * (d[c] - along) * (d[c] - along);
    off_line = std::max(off_line, off);
  }
  FittedBlock candidate;
  candidate.begin = run.begin;
  candidate.e0 =
      pack({to_byte(run.mean[0] + lo), to_byte(run.mean[1] + lo), to_byte(run.mean[2] + lo)});
  const Value8 e0 = precision_.unpack(candidate.e0);
  float low_end = 0;  // of the stored end, along grey
  for (int c = 0; c < 3; ++c) low_end += share[c] * e0[c];
  const int step = static_cast<int>((mean + hi - low_end) / ValueBlock::kStepUnit + 0.5f);
  candidate.second = static_cast<std::uint32_t>(std::clamp(step - 1, 0, 63));
  const auto weight = static_cast<float>(metric_.sum());
  try_line(run, candidate, 1, 3, (hi - lo) * std::sqrt(weight), off_line * weight, best);
}

void BlockFitter::fit_principal(const Run& run, FittedBlock& best) const {
  float scale[3];
  for (int c = 0; c < 3; ++c)
    scale[c] = std::sqrt(static_cast<float>(metric_.weights[static_cast<std::size_t>(c)]));
  const auto scaled = [&](int i) {
    const Value8 v = values_[static_cast<std::size_t>(i)];
    return Vec3f{(v.x - run.mean[0]) * scale[0], (v.y - run.mean[1]) * scale[1],
                 (v.z - run.mean[2]) * scale[2]};
  };
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (int i = run.begin; i < run.end; ++i) {
    const Vec3f d = scaled(i);
    xx += d.x * d.x, xy += d.x * d.y, xz += d.x * d.z;
    yy += d.y * d.y, yz += d.y * d.z, zz += d.z * d.z;
  }
  // A few steps of the power method, from the row of the largest variance.
  Vec3f axis = xx >= yy && xx >= zz ? Vec3f{xx, xy, xz}
               : yy >= zz           ? Vec3f{xy, yy, yz}
                                    : Vec3f{xz, yz, zz};
  for (int i = 0; i < 5; ++i) {
    axis = {xx * axis.x + xy * axis.y + xz * axis.z, xy * axis.x + yy * axis.y + yz * axis.z,
            xz * axis.x + yz * axis.y + zz * axis.z};
    const float length = std::sqrt(dot(axis, axis));
    if (!(length > 0)) return;
    axis = axis * (1 / length);
  }
  float lo = 0, hi = 0, off_line = 0;
  for (int i = run.begin; i < run.end; ++i) {
    const Vec3f d = scaled(i);
    const float along = dot(d, axis);
    lo = std::min(lo, along);
    hi = std::max(hi, along);
    off_line = std::max(off_line, dot(d, d) - along * along);
  }
  const auto end_at = [&](float along) {
    return pack({to_byte(run.mean[0] + along * axis.x / scale[0]),
                 to_byte(run.mean[1] + along * axis.y / scale[1]),
                 to_byte(run.mean[2] + along * axis.z / scale[2])});
  };
  FittedBlock candidate;
  candidate.begin = run.begin;
  candidate.e0 = end_at(lo);
  candidate.second = end_at(hi);
  try_line(run, candidate, 5, 7, hi - lo, off_line, best);
}

FittedBlock BlockFitter::fit(int begin, int end) const {
  Run run{begin, end, values_[static_cast<std::size_t>(begin)], {}, {}};
  run.hi = run.lo;
  int sum[3] = {};
  for (int i = begin; i < end; ++i)
    for (int c = 0; c < 3; ++c) {
      const std::uint8_t v = values_[static_cast<std::size_t>(i)][c];
      run.lo[c] = std::min(run.lo[c], v);
      run.hi[c] = std::max(run.hi[c], v);
      sum[c] += v;
    }
  for (int c = 0; c < 3; ++c)
    run.mean[c] = static_cast<float>(sum[c]) / static_cast<float>(run.count());
  FittedBlock best;
  best.begin = begin;
  best.block.length = run.count();
  if (fit_flat(run, best)) return best;
  best.block.type = ValueBlock::kRaw;
  best.bits = best.block.bits(precision_.bits());
  fit_grey(run, best);
  fit_principal(run, best);
  return best;
}

}  // namespace voxdag
