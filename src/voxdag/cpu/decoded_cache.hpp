#pragma once
/// A cache of decoded nodes of a compact DAG, for one thread of a CPU: 2.5 MiB.
#include <vector>

#include "voxdag/trace/compact_svdag_nodes.hpp"

namespace voxdag {

/// A cache for CompactSvdagNodes. A node takes the place that its bits select from the node that
/// was there.
class DecodedCache {
 public:
  const CompactNode& node(const CompactSvdagView& dag, CompactRange range, int level) {
    Slot<CompactNode>& slot = nodes_[place(range, kNodeBits)];
    if (!slot.holds(range)) detail::decode(dag, range, level, slot.value);
    slot.range = range;
    return slot.value;
  }
  const CompactUnit& unit(const CompactSvdagView& dag, CompactRange range) {
    Slot<CompactUnit>& slot = units_[place(range, kUnitBits)];
    if (!slot.holds(range)) {
      detail::decode(dag, range, slot.value);
      ++decoded_units_;
    }
    slot.range = range;
    return slot.value;
  }
  const DecodedBrick& shared_brick(const CompactSvdagView& dag, std::uint32_t number,
                                   std::uint32_t mask) {
    Slot<DecodedBrick>& slot = bricks_[place({number, 0}, kBrickBits)];
    if (!slot.holds({number, 0})) {
      detail::decode(dag, number, mask, slot.value);
      ++decoded_bricks_;
    }
    slot.range = {number, 0};
    return slot.value;
  }

  /// Returns how many units and shared bricks were decoded so far.
  std::uint64_t decoded_units() const { return decoded_units_; }
  std::uint64_t decoded_bricks() const { return decoded_bricks_; }
  static constexpr std::uint64_t bytes() {
    return (sizeof(Slot<CompactNode>) << kNodeBits) + (sizeof(Slot<CompactUnit>) << kUnitBits) +
           (sizeof(Slot<DecodedBrick>) << kBrickBits);
  }

 private:
  static constexpr int kNodeBits = 12, kUnitBits = 11, kBrickBits = 13;
  template <class T>
  struct Slot {
    CompactRange range{~std::uint64_t{0}, ~std::uint64_t{0}};
    T value;
    bool holds(CompactRange wanted) const {
      return range.begin == wanted.begin && range.end == wanted.end;
    }
  };

  static std::size_t place(CompactRange range, int bits) {
    return static_cast<std::size_t>(range.begin * 0x9E3779B97F4A7C15ull >> (64 - bits));
  }

  std::vector<Slot<CompactNode>> nodes_ = std::vector<Slot<CompactNode>>(1 << kNodeBits);
  std::vector<Slot<CompactUnit>> units_ = std::vector<Slot<CompactUnit>>(1 << kUnitBits);
  std::vector<Slot<DecodedBrick>> bricks_ = std::vector<Slot<DecodedBrick>>(1 << kBrickBits);
  std::uint64_t decoded_units_ = 0, decoded_bricks_ = 0;
};

}  // namespace voxdag
