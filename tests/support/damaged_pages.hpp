#pragma once
/// Pages of values with single bits flipped.
#include <cstdint>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Flips each bit of the words of `good` in turn. Calls accepted(changed, bit) for the changed
/// pages that validate(view) accepts, and returns how many it refuses.
template <class Pages, class Validate, class Accepted>
int refused_bit_flips(const Pages& good, const Validate& validate, const Accepted& accepted) {
  int refused = 0;
  for (std::size_t bit = 0; bit < 64 * good.words.size(); ++bit) {
    Pages changed = good;
    changed.words[bit / 64] ^= std::uint64_t{1} << bit % 64;
    try {
      validate(changed.view());
    } catch (const Error&) {
      ++refused;
      continue;
    }
    accepted(changed, bit);
  }
  return refused;
}

}  // namespace voxdag
