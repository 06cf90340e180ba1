#pragma once
/// Decides which values of a dense volume set their voxel.
#include <cmath>
#include <limits>
#include <type_traits>

namespace voxdag {

/// True for all values but 0 and NaN.
template <class T>
struct IsNotZero {
  bool operator()(T value) const {
    if constexpr (std::is_floating_point_v<T>)
      return value < 0 || value > 0;
    else
      return value != 0;
  }
};

/// True for values that are at least a threshold, exactly: 2^53 + 1 is at least itself. NaN is at
/// least nothing, and nothing is at least NaN.
template <class T>
class IsAtLeast {
 public:
  explicit IsAtLeast(double threshold) {
    if constexpr (std::is_floating_point_v<T>) {
      least_ = threshold;
    } else {
      // 2^digits, the first number above the range, is exact as a double; so is the lowest one.
      const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
      const double least = std::ceil(threshold);
      is_possible_ = least < end;
      if (is_possible_)
        least_ = least <= static_cast<double>(std::numeric_limits<T>::min())
                     ? std::numeric_limits<T>::min()
                     : static_cast<T>(least);
    }
  }

  bool operator()(T value) const { return value >= least_ && is_possible_; }

 private:
  std::conditional_t<std::is_floating_point_v<T>, double, T> least_{};
  bool is_possible_ = true;
};

/// Applies a test to value * slope + intercept.
template <class T, class Test>
struct ScaledTest {
  Test test;
  double slope, intercept;

  bool operator()(T value) const { return test(static_cast<double>(value) * slope + intercept); }
};

}  // namespace voxdag
