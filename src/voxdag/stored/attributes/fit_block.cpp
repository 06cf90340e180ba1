#include "voxdag/stored/attributes/fit_block.hpp"

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

std::uint32_t pack_end(Value8 value, PagePrecision precision) {
  static const NearestFields nearest;
  std::uint32_t end = 0;
  for (int c = 2; c >= 0; --c) {
    const int bits = precision.channel_bits(c);
    end = end << bits | nearest(bits, value[c]);
  }
  return end;
}

BlockFitter::BlockFitter(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
                         PagePrecision precision)
    : values_(values), metric_(metric), precision_(precision), price_(metric.price()) {}

std::uint32_t BlockFitter::pack(const float (&value)[3]) const {
  return pack_end({to_byte(value[0]), to_byte(value[1]), to_byte(value[2])}, precision_);
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

/// Sets the cost of a line and the sums of its weights. Returns false if an error is above the
/// bound.
bool BlockFitter::measure(FittedBlock& fitted, WeightSums& sums) const {
  const Line line = line_of(fitted);
  std::uint32_t errors = 0;  // at most 256 * 65025 * sum of the weights
  int largest = 0;
  for (int i = fitted.begin; i < fitted.end(); ++i) {
    const Value8 value = values_[static_cast<std::size_t>(i)];
    const int k = line.nearest(value);
    const int error = metric_.error(value, line.palette[k]);
    largest = std::max(largest, error);
    errors += static_cast<std::uint32_t>(error);
    sums.weights += k;
    sums.squares += k * k;
    for (int c = 0; c < 3; ++c) sums.products[static_cast<std::size_t>(c)] += k * value[c];
  }
  fitted.cost =
      static_cast<float>(precision_.bits_of(fitted.block)) + price_ * static_cast<float>(errors);
  return largest <= metric_.bound;
}

/// Sets the cost of a block without weights. Returns false if an error is above the bound.
bool BlockFitter::measure_constant(FittedBlock& fitted) const {
  const bool is_flat = fitted.block.type == ValueBlock::kFlat;
  const Value8 e0 = precision_.unpack(fitted.e0);
  std::uint32_t errors = 0;
  int largest = 0;
  for (int i = fitted.begin; i < fitted.end(); ++i) {
    const Value8 value = values_[static_cast<std::size_t>(i)];
    const int error =
        metric_.error(value, is_flat ? e0 : precision_.unpack(pack_end(value, precision_)));
    largest = std::max(largest, error);
    errors += static_cast<std::uint32_t>(error);
  }
  fitted.cost =
      static_cast<float>(precision_.bits_of(fitted.block)) + price_ * static_cast<float>(errors);
  return largest <= metric_.bound;
}

/// Replaces `best` by one value for all, if that keeps the bound and costs less.
void BlockFitter::try_flat(const ValueSums& sums, FittedBlock& best) const {
  FittedBlock candidate = best;
  candidate.block.type = ValueBlock::kFlat;
  candidate.e0 = pack({sums.mean(0), sums.mean(1), sums.mean(2)});
  bool keeps_bound = measure_constant(candidate);
  if (!keeps_bound) {
    float middle[3];
    for (std::size_t c = 0; c < 3; ++c)
      middle[c] = 0.5f * static_cast<float>(sums.lo[c] + sums.hi[c]);
    candidate.e0 = pack(middle);
    keeps_bound = measure_constant(candidate);
  }
  if (keeps_bound && candidate.cost < best.cost) best = candidate;
}

/// Sets the ends of a line along grey. Returns false if there is no such line.
bool BlockFitter::set_grey(const float (&low)[3], float length, FittedBlock& candidate) const {
  candidate.e0 = pack(low);
  const Value8 e0 = precision_.unpack(candidate.e0);
  float rounding = 0;  // of the stored end, along grey
  for (int c = 0; c < 3; ++c)
    rounding += static_cast<float>(metric_.weights[static_cast<std::size_t>(c)]) *
                (low[c] - static_cast<float>(e0[c]));
  length += rounding / static_cast<float>(metric_.sum());
  const int step = static_cast<int>(length / ValueBlock::kStepUnit + 0.5f);
  candidate.second = static_cast<std::uint32_t>(std::clamp(step - 1, 0, 63));
  return length > 0;
}

/// Measures a line, then the line that fits its weights best. Replaces `best` by those that keep
/// the bound and cost less.
void BlockFitter::try_line(FittedBlock& candidate, const ValueSums& sums, FittedBlock& best) const {
  for (int round = 0; round < 2; ++round) {
    WeightSums weights;
    if (measure(candidate, weights) && candidate.cost < best.cost) best = candidate;
    if (round == 1) return;
    // Least squares: value = low + slope * weight.
    const auto n = static_cast<float>(sums.count);
    const float most = static_cast<float>((1 << candidate.block.weight_bits()) - 1);
    const float mean_weight = static_cast<float>(weights.weights) / n;
    const float spread =
        static_cast<float>(weights.squares) - static_cast<float>(weights.weights) * mean_weight;
    if (!(spread > 0)) return;
    float slope[3], mean_slope = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      slope[c] = (static_cast<float>(weights.products[c]) -
                  static_cast<float>(sums.sum[c]) * mean_weight) /
                 spread;
      mean_slope += static_cast<float>(metric_.weights[c]) * slope[c];
    }
    if (candidate.block.has_step())
      for (float& s : slope) s = mean_slope / static_cast<float>(metric_.sum());
    float low[3], high[3];
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = sums.mean(c) - slope[c] * mean_weight;
      high[c] = low[c] + slope[c] * most;
    }
    if (candidate.block.has_step()) {
      if (!set_grey(low, slope[0] * most, candidate)) return;
    } else {
      candidate.e0 = pack(low);
      candidate.second = pack(high);
    }
  }
}

/// Tries lines of the types from `first_type` on, with weights of more and more bits, until their
/// bits alone cost more than `best`. `off_line` is the sum of the errors between the values and the
/// line, and set_ends(candidate) sets the ends to those of the values.
template <class SetEnds>
void BlockFitter::try_lines(int first_type, float off_line, const ValueSums& sums,
                            const SetEnds& set_ends, FittedBlock& best) const {
  for (int type = first_type; type < first_type + 3; ++type) {
    FittedBlock candidate = best;
    candidate.block.type = type;
    const auto bits = static_cast<float>(precision_.bits_of(candidate.block));
    if (bits + price_ * off_line >= best.cost) return;
    set_ends(candidate);
    try_line(candidate, sums, best);
  }
}

FittedBlock BlockFitter::fit(int begin, const ValueSums& sums) const {
  FittedBlock best;
  best.begin = begin;
  best.block.length = sums.count;
  best.block.type = ValueBlock::kRaw;
  measure_constant(best);
  try_flat(sums, best);

  const float total = total_spread(sums, metric_), grey = grey_spread(sums, metric_);
  const float means[3] = {sums.mean(0), sums.mean(1), sums.mean(2)};
  const auto weights = static_cast<float>(metric_.sum());
  try_lines(
      1, std::max(total - grey, 0.0f), sums,
      [&](FittedBlock& candidate) {
        float mean = 0;
        for (std::size_t c = 0; c < 3; ++c)
          mean += static_cast<float>(metric_.weights[c]) * means[c] / weights;
        const float below = static_cast<float>(sums.lo[5]) / weights - mean;
        set_grey({means[0] + below, means[1] + below, means[2] + below},
                 static_cast<float>(sums.hi[5] - sums.lo[5]) / weights, candidate);
      },
      best);

  const PrincipalAxis axis = principal_axis(sums, metric_);
  const AxisExtent extent =
      extent_along(axis, &values_[static_cast<std::size_t>(begin)], sums, metric_);
  const auto end_at = [&](float along) {
    float end[3];
    for (std::size_t c = 0; c < 3; ++c)
      end[c] =
          means[c] + along * axis.direction[c] / std::sqrt(static_cast<float>(metric_.weights[c]));
    return pack(end);
  };
  try_lines(
      5, std::max(total - axis.spread, 0.0f), sums,
      [&](FittedBlock& candidate) {
        candidate.e0 = end_at(extent.lo);
        candidate.second = end_at(extent.hi);
      },
      best);
  return best;
}

}  // namespace voxdag
