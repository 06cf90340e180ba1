#include <algorithm>
#include <array>
#include <limits>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/compact/compact_errors.hpp"
#include "voxdag/stored/compact/compact_top.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/stored/svdag/unique_cells.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Expands the nodes above the units, then reads the units in parallel and appends them in their
/// order, which is the canonical one.
class Decoder {
 public:
  Decoder(const CompactSvdagView& compact, Work work)
      : compact_(compact),
        work_(work),
        levels_(compact.coded_levels()),
        units_(work.memory),
        shared_places_(compact.shared_nodes(levels_ - 3), kNone, work.memory),
        leaf_blocks_(work.memory) {}

  Svdag decode() {
    CompactTop top = expand_top(compact_, work_);
    words_ = std::move(top.levels);
    units_ = std::move(top.units);
    for (int i = 0; i < 2; ++i)
      words_.emplace_back(work_.memory);  // of the units and of the bricks
    read_shared_bricks();
    place_units();
    return assemble();
  }

 private:
  static std::size_t at(int level) { return static_cast<std::size_t>(level); }
  int unit_level() const { return levels_ - 4; }

  /// Appends a node without pointers. Returns its first word.
  std::size_t append_mask(int level, std::uint32_t mask) {
    CountedVector<std::uint32_t>& words = words_[at(level)];
    const std::size_t place = words.size();
    if (place > kNone - 16) fail_too_large();
    words.resize(place + static_cast<std::size_t>(1 + popcount(mask)));
    words[place] = mask;
    return place;
  }

  void read_shared_bricks() {
    const int level = levels_ - 3;
    bricks_.resize(compact_.shared_nodes(level));
    bricks_memory_ = MemoryReservation(work_.memory, bricks_.size() * sizeof(Brick));
    polled_for(bricks_.size(), 1024, work_, "decode", [&](std::size_t i) {
      const std::uint64_t* first = compact_.brick_first;
      const auto mask =
          static_cast<std::uint32_t>(std::upper_bound(first, first + 257, i) - first - 1);
      if (read_shared_brick(compact_, shared_node(compact_, level, i), mask, bricks_[i].leaves) !=
          CompactFault::kNone)
        fail_broken_stream();
    });
  }

  void place_units() {
    unit_places_.reserve(units_.size());
    constexpr std::size_t kBatch = 1 << 14;
    std::vector<CompactUnit> batch(std::min(kBatch, units_.size()));
    const MemoryReservation read(work_.memory,
                                 batch.size() * sizeof(CompactUnit) + units_.size() * 4);
    for (std::size_t first = 0; first < units_.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, units_.size() - first);
      parallel_for((count + 255) / 256, [&](std::size_t part) {
        work_.poll();
        for (std::size_t i = part * 256; i < std::min(count, part * 256 + 256); ++i)
          if (read_unit(compact_, units_[first + i], batch[i]) != CompactFault::kNone)
            fail_broken_stream();
      });
      for (std::size_t i = 0; i < count; ++i) place_unit(batch[i]);
      work_.report_done("decode", first + count, units_.size());
    }
  }

  void place_unit(const CompactUnit& unit) {
    const std::size_t place = append_mask(unit_level(), unit.mask);
    unit_places_.push_back(static_cast<std::uint32_t>(place));
    std::size_t word = place + 1;
    for (int i = 0; i < 8; ++i) {
      if ((unit.mask >> i & 1) == 0) continue;
      std::uint32_t child = 0;
      if ((unit.inline_mask >> i & 1) != 0) {
        child = place_brick(unit.bricks[i]);
      } else {
        std::uint32_t& brick = shared_places_[unit.shared[i]];
        if (brick == kNone) brick = place_brick(bricks_[unit.shared[i]].leaves);
        child = brick;
      }
      words_[at(unit_level())][word++] = child;
    }
  }

  std::uint32_t place_brick(const std::uint64_t (&leaves)[8]) {
    std::uint32_t mask = 0;
    for (int q = 0; q < 8; ++q) mask |= leaves[q] != 0 ? 1u << q : 0u;
    const std::size_t place = append_mask(levels_ - 3, mask);
    std::uint32_t* word = words_[at(levels_ - 3)].data() + place;
    for (const std::uint64_t leaf : leaves)
      if (leaf != 0) *++word = leaf_blocks_.add(leaf);
    return static_cast<std::uint32_t>(place);
  }

  /// Joins the levels, without those that the coded grid has above the DAG's grid.
  Svdag assemble() {
    Svdag dag;
    dag.levels = compact_.levels;
    const int missing = levels_ - dag.levels;
    std::uint64_t total = 0;
    for (int level = missing; level <= levels_ - 3; ++level) total += words_[at(level)].size();
    if (total > kNone - 256) fail_too_large();
    const MemoryReservation memory(work_.memory, total * 4 + leaf_blocks_.cells().size() * 8);
    dag.nodes.reserve(total);
    for (int level = missing; level <= levels_ - 3; ++level) {
      CountedVector<std::uint32_t>& words = words_[at(level)];
      const auto begin = static_cast<std::uint32_t>(dag.nodes.size());
      const std::uint32_t next =
          level == levels_ - 3 ? 0 : begin + static_cast<std::uint32_t>(words.size());
      dag.level_begin[at(level - missing)] = begin;
      for (std::size_t i = 0; i < words.size();) {
        dag.nodes.push_back(words[i]);
        for (const std::size_t end = i + static_cast<std::size_t>(popcount(words[i])); i != end;) {
          const std::uint32_t child = words[++i];
          dag.nodes.push_back(next + (level + 1 == unit_level() ? unit_places_[child] : child));
        }
        ++i;
      }
      CountedVector<std::uint32_t>(words.get_allocator()).swap(words);
    }
    for (int level = std::max(dag.levels - 2, 0); level <= kMaxLevels; ++level)
      dag.level_begin[at(level)] = dag.nodes.size();
    dag.leaf_blocks.assign(leaf_blocks_.cells().begin(), leaf_blocks_.cells().end());
    return dag;
  }

  struct Brick {
    std::uint64_t leaves[8];
  };

  const CompactSvdagView& compact_;
  Work work_;
  int levels_;  ///< The coded levels.
  std::vector<CountedVector<std::uint32_t>>
      words_;  ///< By level; pointers count from the level's first word.
  CountedVector<CompactRange> units_;
  CountedVector<std::uint32_t> shared_places_;  ///< First words of the shared bricks.
  std::vector<std::uint32_t> unit_places_;
  std::vector<Brick> bricks_;  ///< The shared ones.
  MemoryReservation bricks_memory_;
  UniqueCells<std::uint64_t> leaf_blocks_;
};

}  // namespace

Svdag decode_svdag(const CompactSvdagView& compact, Work work) {
  if (compact.is_empty()) {
    Svdag dag;
    dag.levels = compact.levels;
    return dag;
  }
  return Decoder(compact, work).decode();
}

}  // namespace voxdag
