#pragma once
/// A cache of decoded units of a compact DAG.
#include <cstdint>
#include <vector>

#include "voxdag/cpu/packets/decoded_unit.hpp"

namespace voxdag {

class InPlaceDag;

/// The units that one thread decoded last.
class UnitCache {
 public:
  /// `units` is the number of units that the cache holds: a power of two.
  explicit UnitCache(std::size_t units)
      : units_(units), numbers_(units, kNone), bricks_(kBricks), brick_numbers_(kBricks, kNone) {}

  /// Returns a unit of the DAG. The reference is valid until the next call.
  const DecodedUnit& unit(const InPlaceDag& dag, std::uint32_t number) {
    const std::size_t place = number & (units_.size() - 1);
    if (numbers_[place] != number) decode(dag, number, place);
    return units_[place];
  }
  /// Returns how many units were decoded so far.
  std::uint64_t decoded_units() const { return decoded_units_; }
  std::uint64_t bytes() const;

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  static constexpr std::size_t kBricks = 1 << 12;

  void decode(const InPlaceDag& dag, std::uint32_t number, std::size_t place);
  const DecodedBrick& shared_brick(const CompactSvdagView& compact, std::uint32_t number,
                                   std::uint32_t mask);

  std::vector<DecodedUnit> units_;
  std::vector<std::uint64_t> numbers_;  ///< The number of each unit of `units_`, or kNone.
  std::vector<DecodedBrick> bricks_;    ///< Shared bricks.
  std::vector<std::uint64_t> brick_numbers_;
  CompactUnit unit_;  ///< The unit that decode() reads.
  std::uint64_t decoded_units_ = 0;
};

}  // namespace voxdag
