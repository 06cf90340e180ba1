#include "voxdag/cpu/packets/unit_cache.hpp"

#include "voxdag/cpu/packets/in_place_dag.hpp"

namespace voxdag {

std::uint64_t UnitCache::bytes() const {
  return units_.size() * (sizeof(DecodedUnit) + sizeof(std::uint64_t)) +
         bricks_.size() * (sizeof(DecodedBrick) + sizeof(std::uint64_t));
}

void UnitCache::decode(const InPlaceDag& dag, std::uint32_t number, std::size_t place) {
  const CompactSvdagView& compact = dag.compact();
  detail::decode(compact, dag.unit(number), unit_);
  set_unit(
      unit_,
      [&](std::uint32_t brick, std::uint32_t mask) -> const DecodedBrick& {
        return shared_brick(compact, brick, mask);
      },
      units_[place]);
  numbers_[place] = number;
  ++decoded_units_;
}

const DecodedBrick& UnitCache::shared_brick(const CompactSvdagView& compact, std::uint32_t number,
                                            std::uint32_t mask) {
  const std::size_t place = number & (kBricks - 1);
  if (brick_numbers_[place] != number) detail::decode(compact, number, mask, bricks_[place]);
  brick_numbers_[place] = number;
  return bricks_[place];
}

}  // namespace voxdag
