#include "voxdag/cpu/packets/in_place_dag.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "voxdag/core/error.hpp"
#include "voxdag/layout/compact/compact_top.hpp"
#include "voxdag/parallel/polled_for.hpp"

namespace voxdag {
namespace {

[[noreturn]] void fail() { throw Error("the stream of the compact DAG is broken"); }

/// Returns the boxes of all shared bricks.
std::vector<CellBox> boxes_of_bricks(const CompactSvdagView& compact, Progress* progress) {
  const int level = compact.coded_levels() - 3;
  std::vector<CellBox> boxes(compact.shared_nodes(level));
  polled_for(boxes.size(), 1024, progress, "open", [&](std::size_t i) {
    const std::uint64_t* first = compact.brick_first;
    const auto mask =
        static_cast<std::uint32_t>(std::upper_bound(first, first + 257, i) - first - 1);
    std::uint64_t leaves[8];
    if (read_shared_brick(compact, shared_node(compact, level, i), mask, leaves) !=
        CompactFault::kNone)
      fail();
    CellExtent extent;
    for (std::uint32_t q = 0; q < 8; ++q)
      if (leaves[q] != 0) extent.add(box_of(leaves[q]), q);
    boxes[i] = extent.box();
  });
  return boxes;
}

/// Returns the boxes of all units.
std::vector<CellBox> boxes_of_units(const CompactSvdagView& compact,
                                    const CountedVector<CompactRange>& units, Progress* progress) {
  const std::vector<CellBox> bricks = boxes_of_bricks(compact, progress);
  std::vector<CellBox> boxes(units.size());
  polled_for(units.size(), 1024, progress, "open", [&](std::size_t i) {
    CompactUnit unit;
    if (read_unit(compact, units[i], unit) != CompactFault::kNone) fail();
    CellExtent extent;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      if ((unit.mask >> octant & 1) == 0) continue;
      CellExtent brick;
      if ((unit.inline_mask >> octant & 1) != 0) {
        for (std::uint32_t q = 0; q < 8; ++q)
          if (const std::uint64_t leaf = unit.bricks[octant][q]; leaf != 0)
            brick.add(box_of(leaf), q);
        extent.add(brick.box(), octant);
      } else {
        extent.add(bricks[unit.shared[octant]], octant);
      }
    }
    boxes[i] = extent.box();
  });
  return boxes;
}

}  // namespace

std::uint64_t UnitCache::bytes() const {
  return units_.size() * (sizeof(DecodedUnit) + sizeof(std::uint64_t)) +
         bricks_.size() * (sizeof(DecodedBrick) + sizeof(std::uint64_t));
}

void UnitCache::decode(const InPlaceDag& dag, std::uint32_t number, std::size_t place) {
  const CompactSvdagView& compact = dag.compact();
  if (read_unit(compact, dag.unit(number), unit_) != CompactFault::kNone) unit_.mask = 0;
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

InPlaceDag::InPlaceDag(const CompactSvdagView& compact, std::size_t cached_units,
                       Progress* progress)
    : compact_(compact), top_(std::make_shared<Top>(cached_units)) {
  assert(compact.levels >= 4);
  if (compact.is_empty()) return;
  const CompactTop top = expand_top(compact, nullptr, [=] { poll(progress); });
  const std::vector<CellBox> unit_boxes = boxes_of_units(compact, top.units, progress);
  top_->units.reserve(top.units.size());
  for (const CompactRange range : top.units) {
    if (range.end - range.begin > kMostLength || range.begin >> (64 - kLengthBits) != 0) fail();
    top_->units.push_back(range.begin << kLengthBits | (range.end - range.begin));
  }

  // Each level's first word, and that behind the last level.
  std::vector<std::size_t> begins{0};
  for (const auto& words : top.levels) begins.push_back(begins.back() + words.size());
  if (begins.back() > std::numeric_limits<std::uint32_t>::max())
    throw Error("the DAG is too large: its nodes have more words than 32-bit pointers can address");
  // It is safe to read eight words from every box on.
  top_->words.assign(2 * begins.back() + 7, 0);
  std::uint32_t* const all = top_->words.data();
  for (std::size_t level = top.levels.size(); level-- > 0;) {
    const bool above_units = level + 1 == top.levels.size();
    const auto& words = top.levels[level];
    for (std::size_t i = 0; i < words.size();) {
      const std::uint32_t mask = words[i];
      const auto count = static_cast<std::size_t>(popcount8(mask));
      std::uint32_t* const node = all + 2 * (begins[level] + i);
      CellExtent extent;
      std::uint32_t rest = mask;
      for (std::size_t c = 0; c < count; ++c, rest &= rest - 1) {
        const std::size_t child = words[i + 1 + c] + (above_units ? 0 : begins[level + 1]);
        const CellBox box = above_units ? unit_boxes[child] : CellBox{all[2 * child + 1]};
        extent.add(box, static_cast<std::uint32_t>(lowest_bit64(rest)));
        node[2 + c] = static_cast<std::uint32_t>(child);
        node[2 + count + c] = box.bits;
      }
      node[0] = mask;
      node[1] = extent.box().bits;
      i += 1 + count;
    }
  }
}

std::uint64_t InPlaceDag::bytes() const {
  return top_->words.size() * sizeof(std::uint32_t) + top_->units.size() * sizeof(std::uint64_t);
}

std::uint64_t InPlaceDag::decoded_units() const {
  std::uint64_t count = 0;
  for (const UnitCache& cache : top_->caches) count += cache.decoded_units();
  return count;
}

}  // namespace voxdag
