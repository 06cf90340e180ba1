#include "voxdag/cpu/packets/in_place_dag.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/compact/compact_errors.hpp"
#include "voxdag/stored/compact/compact_top.hpp"

namespace voxdag {
namespace {

/// Returns the boxes of all shared bricks.
std::vector<CellBox> boxes_of_bricks(const CompactSvdagView& compact, Work work) {
  const int level = compact.coded_levels() - 3;
  std::vector<CellBox> boxes(compact.shared_nodes(level));
  polled_for(boxes.size(), 1024, work, "open", [&](std::size_t i) {
    const std::uint64_t* first = compact.brick_first;
    const auto mask =
        static_cast<std::uint32_t>(std::upper_bound(first, first + 257, i) - first - 1);
    std::uint64_t leaves[8];
    if (read_shared_brick(compact, shared_node(compact, level, i), mask, leaves) !=
        CompactFault::kNone)
      fail_broken_stream();
    boxes[i] = box_of(leaves);
  });
  return boxes;
}

/// Returns the boxes of all units.
std::vector<CellBox> boxes_of_units(const CompactSvdagView& compact,
                                    const CountedVector<CompactRange>& units, Work work) {
  const std::vector<CellBox> bricks = boxes_of_bricks(compact, work);
  std::vector<CellBox> boxes(units.size());
  polled_for(units.size(), 1024, work, "open", [&](std::size_t i) {
    CompactUnit unit;
    if (read_unit(compact, units[i], unit) != CompactFault::kNone) fail_broken_stream();
    CellExtent extent;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      if ((unit.mask >> octant & 1) == 0) continue;
      const bool is_inline = (unit.inline_mask >> octant & 1) != 0;
      extent.add(is_inline ? box_of(unit.bricks[octant]) : bricks[unit.shared[octant]], octant);
    }
    boxes[i] = extent.box();
  });
  return boxes;
}

}  // namespace

InPlaceDag::InPlaceDag(const CompactSvdagView& compact, std::size_t cached_units, Work work)
    : compact_(compact), top_(std::make_shared<Top>(cached_units)) {
  assert(compact.levels >= 4);
  if (compact.is_empty()) return;
  const CompactTop top = expand_top(compact, work);
  const std::vector<CellBox> unit_boxes = boxes_of_units(compact, top.units, work);
  top_->units.reserve(top.units.size());
  for (const CompactRange range : top.units) {
    if (range.end - range.begin > kMaxLength || range.begin >> (64 - kLengthBits) != 0)
      fail_broken_stream();
    top_->units.push_back(range.begin << kLengthBits | (range.end - range.begin));
  }

  // The first word of each level, and the word behind the last level.
  std::vector<std::size_t> begins{0};
  for (const auto& words : top.levels) begins.push_back(begins.back() + words.size());
  if (begins.back() > std::numeric_limits<std::uint32_t>::max()) fail_too_large();
  // Eight words must be safe to read from the last box on.
  top_->words.assign(2 * begins.back() + 7, 0);
  std::uint32_t* const all = top_->words.data();
  for (std::size_t level = top.levels.size(); level-- > 0;) {
    const bool above_units = level + 1 == top.levels.size();
    const auto& words = top.levels[level];
    for (std::size_t i = 0; i < words.size();) {
      write_bounded_node(
          words[i], all + 2 * (begins[level] + i), [&](std::uint32_t c, std::uint32_t) {
            const std::size_t child = words[i + 1 + c] + (above_units ? 0 : begins[level + 1]);
            return BoundedChild{
                static_cast<std::uint32_t>(child),
                above_units ? unit_boxes[child] : bounded_node_box(all + 2 * child)};
          });
      i += bounded_node_words(words[i]) / 2;
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
