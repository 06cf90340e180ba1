#pragma once
/// Fits a block to a run of values: few bits and small errors, none above the bound.
#include <array>
#include <cstdint>
#include <span>

#include "voxdag/stored/attributes/estimate_block.hpp"

namespace voxdag {

/// A block of the values from `begin` on.
struct FittedBlock {
  ValueBlock block;
  int begin = 0;
  float cost = 0;            ///< Bits of the whole block, plus the price of its errors in bits.
  std::uint32_t e0 = 0;      ///< Packed end.
  std::uint32_t second = 0;  ///< Packed end, or the step.

  int end() const { return begin + block.length; }
};

/// Returns the end that is nearest to a value.
std::uint32_t pack_end(Value8 value, PagePrecision precision);

/// Fits blocks to the values of one page.
class BlockFitter {
 public:
  /// Refers to the metric.
  BlockFitter(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
              PagePrecision precision);

  /// Returns the block of least cost that was found for the values from `begin` on, whose sums are
  /// `sums`; `begin` and their number are multiples of kBlockUnit. Tries one value for all, lines
  /// along grey and along the principal axis, and every value by itself.
  FittedBlock fit(int begin, const ValueSums& sums) const;

  /// Calls add(number, bits) for each end, step and weight of a block, in the order of the file,
  /// and is_stored(i, stored) for each value of the page that the block holds.
  template <class Add, class IsStored>
  void write(const FittedBlock& fitted, const Add& add, const IsStored& is_stored) const {
    const int end_bits = precision_.bits();
    const ValueBlock& block = fitted.block;
    if (block.type == ValueBlock::kRaw) {
      for (int i = fitted.begin; i < fitted.end(); ++i) {
        const std::uint32_t end = pack_end(values_[static_cast<std::size_t>(i)], precision_);
        add(end, end_bits);
        is_stored(i, precision_.unpack(end));
      }
      return;
    }
    add(fitted.e0, end_bits);
    if (!block.is_line()) {
      const Value8 e0 = precision_.unpack(fitted.e0);
      for (int i = fitted.begin; i < fitted.end(); ++i) is_stored(i, e0);
      return;
    }
    add(fitted.second, block.has_step() ? ValueBlock::kStepBits : end_bits);
    const Line line = line_of(fitted);
    for (int i = fitted.begin; i < fitted.end(); ++i) {
      const int k = line.nearest(values_[static_cast<std::size_t>(i)]);
      add(static_cast<std::uint64_t>(k), block.weight_bits());
      is_stored(i, line.palette[k]);
    }
  }

 private:
  /// The values between two ends.
  struct Line {
    Value8 palette[16];
    int most = 1;         // the largest weight
    float along[3] = {};  // change of the weight per step of each channel
    float offset = 0;     // the weight of the value (0, 0, 0), plus one half for rounding

    int nearest(Value8 value) const {
      const float k = along[0] * value[0] + along[1] * value[1] + along[2] * value[2] + offset;
      const int rounded = static_cast<int>(k < 0 ? 0.0f : k);
      return rounded < most ? rounded : most;
    }
  };
  /// Sums over the weights of a block's values.
  struct WeightSums {
    int weights = 0, squares = 0;   ///< Sums of the weights and of their squares.
    std::array<int, 3> products{};  ///< Sums of weight times channel.
  };

  std::uint32_t pack(const float (&value)[3]) const;
  Line line_of(const FittedBlock& fitted) const;
  bool measure(FittedBlock& fitted, WeightSums& sums) const;
  bool measure_constant(FittedBlock& fitted) const;
  void try_flat(const ValueSums& sums, FittedBlock& best) const;
  template <class SetEnds>
  void try_lines(int first_type, float off_line, const ValueSums& sums, const SetEnds& set_ends,
                 FittedBlock& best) const;
  void try_line(FittedBlock& candidate, const ValueSums& sums, FittedBlock& best) const;
  bool set_grey(const float (&low)[3], float length, FittedBlock& candidate) const;

  std::span<const Value8, kPageValues> values_;
  const ValueMetric& metric_;
  PagePrecision precision_;
  float price_;
};

}  // namespace voxdag
