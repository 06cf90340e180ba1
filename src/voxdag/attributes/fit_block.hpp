#pragma once
/// Fits a block to a run of values: few bits, and no error above the bound.
#include <cstdint>
#include <span>

#include "voxdag/attributes/encode_page.hpp"

namespace voxdag {

/// A block of the values from `begin` on.
struct FittedBlock {
  ValueBlock block;
  int begin = 0;
  int bits = 0;              ///< Size of the whole block.
  std::uint32_t e0 = 0;      ///< Packed end.
  std::uint32_t second = 0;  ///< Packed end, or the step.

  int end() const { return begin + block.length; }
};

/// Fits blocks to the values of one page.
class BlockFitter {
 public:
  BlockFitter(std::span<const Value8, kPageValues> values, const ValueMetric& metric,
              EndPrecision precision);

  /// Returns a block of the values `begin` to `end` - 1; both are multiples of kBlockUnit. Chooses
  /// one value for all if that keeps the bound; otherwise the smallest of a line along grey, a line
  /// along the principal axis, and every value by itself.
  FittedBlock fit(int begin, int end) const;

  /// Calls add(number, bits) for each end, step and weight of a block, in the order of the file,
  /// and is_stored(i, stored) for each value of the page that the block holds.
  template <class Add, class IsStored>
  void write(const FittedBlock& fitted, const Add& add, const IsStored& is_stored) const {
    const int end_bits = precision_.bits();
    const ValueBlock& block = fitted.block;
    if (block.type == ValueBlock::kRaw) {
      for (int i = fitted.begin; i < fitted.end(); ++i) {
        const std::uint32_t end = pack(values_[static_cast<std::size_t>(i)]);
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
  struct Run;

  std::uint32_t pack(Value8 value) const;
  Line line_of(const FittedBlock& fitted) const;
  bool keeps_bound(const FittedBlock& fitted) const;
  bool fit_flat(const Run& run, FittedBlock& fitted) const;
  void fit_grey(const Run& run, FittedBlock& best) const;
  void fit_principal(const Run& run, FittedBlock& best) const;
  void try_line(const Run& run, FittedBlock candidate, int first_type, int last_type, float range,
                float off_line, FittedBlock& best) const;

  std::span<const Value8, kPageValues> values_;
  ValueMetric metric_;
  EndPrecision precision_;
};

}  // namespace voxdag
