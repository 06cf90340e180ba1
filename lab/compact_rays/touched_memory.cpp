#include "lab/compact_rays/touched_memory.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "voxdag/trace/compact_svdag_nodes.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag::lab {
namespace {

/// The arrays of a DAG.
enum Array { kNodes, kLeafBlocks, kStream, kSharedBegin };

/// The bytes that one ray reads, by their places in arrays that begin with a line. So the counts
/// do not depend on addresses.
class Touched {
 public:
  /// Notes that the ray reads the words that hold the bytes from `first` to before `end`.
  void add(Array array, std::uint64_t first, std::uint64_t end) {
    const std::uint64_t begin = std::uint64_t{array} << 56;
    for (std::uint64_t word = first / kWord; word < (end + kWord - 1) / kWord; ++word)
      words_.insert(begin / kWord + word);
  }
  void add_symbols(int count) { symbols_ += static_cast<std::uint64_t>(count); }

  /// Adds what this ray read to `sum`, and forgets it.
  void move_to(TouchedMemory& sum) {
    std::unordered_set<std::uint64_t> lines;
    for (const std::uint64_t word : words_) lines.insert(word * kWord / kLine);
    sum.bytes += static_cast<double>(words_.size() * kWord);
    sum.lines += static_cast<double>(lines.size());
    sum.symbols += static_cast<double>(symbols_);
    words_.clear();
    symbols_ = 0;
  }

 private:
  static constexpr std::uint64_t kWord = 4, kLine = 64;
  std::unordered_set<std::uint64_t> words_;
  std::uint64_t symbols_ = 0;
};

/// Notes the words that the walk at the plain form reads.
class TouchingNodes : public SvdagNodes {
 public:
  using Path = NodePath<TouchingNodes>;
  TouchingNodes(const SvdagView& dag, Touched& touched) : SvdagNodes(dag), touched_(&touched) {}

  std::uint32_t child_mask(Node node, int level) const {
    if (level < levels() - 2)
      add_node_word(node);
    else if (level == levels() - 2)
      touched_->add(kLeafBlocks, std::uint64_t{8} * node, std::uint64_t{8} * node + 8);
    return SvdagNodes::child_mask(node, level);
  }
  Node child(Node node, int level, int index) const {
    if (level < levels() - 2)
      add_node_word(std::uint64_t{node} + 1 +
                    popcount(SvdagNodes::child_mask(node, level) & ((1u << index) - 1)));
    return SvdagNodes::child(node, level, index);
  }

 private:
  void add_node_word(std::uint64_t word) const { touched_->add(kNodes, 4 * word, 4 * word + 4); }

  Touched* touched_;
};

int symbols_of(const std::uint64_t (&leaves)[8]) {
  int count = 0;
  for (const std::uint64_t leaf : leaves)
    if (leaf != 0) count += 1 + popcount(leaf_block_child_mask(leaf));
  return count;
}

int symbols_of(const CompactUnit& unit) {
  int count = 1 + 2 * popcount(unit.mask);
  for (int i = 0; i < 8; ++i)
    if ((unit.inline_mask >> i & 1) != 0) count += symbols_of(unit.bricks[i]);
  return count;
}

/// Keeps all that a ray decodes, and notes what it reads for that. See compact_svdag_nodes.hpp.
class TouchingCache {
 public:
  explicit TouchingCache(Touched& touched) : touched_(&touched) {}

  const CompactNode& node(const CompactSvdagView& dag, CompactRange range, int level) {
    const auto [place, is_new] = nodes_.try_emplace(range.begin);
    CompactNode& node = place->second;
    if (!is_new) return node;
    detail::decode(dag, range, level, node);
    // The record ends where the first inline child begins.
    std::uint64_t end = range.end;
    for (int i = 7; i >= 0; --i) {
      if ((node.mask >> i & 1) == 0) continue;
      if ((node.inline_mask >> i & 1) != 0)
        end = node.children[i].begin;
      else
        add_place(dag, level + 1, node.shared[i]);
    }
    add_bits({range.begin, end});
    const int inline_children = popcount(node.inline_mask);
    const bool above_units = level + 1 == dag.coded_levels() - 4;
    touched_->add_symbols(1 + popcount(node.mask) +
                          (above_units ? std::max(inline_children - 1, 0) : 0));
    return node;
  }
  const CompactUnit& unit(const CompactSvdagView& dag, CompactRange range) {
    const auto [place, is_new] = units_.try_emplace(range.begin);
    CompactUnit& unit = place->second;
    if (!is_new) return unit;
    detail::decode(dag, range, unit);
    add_bits(range);
    touched_->add_symbols(symbols_of(unit));
    return unit;
  }
  const DecodedBrick& shared_brick(const CompactSvdagView& dag, std::uint32_t number,
                                   std::uint32_t mask) {
    const auto [place, is_new] = bricks_.try_emplace(number);
    DecodedBrick& brick = place->second;
    if (!is_new) return brick;
    detail::decode(dag, number, mask, brick);
    const int level = dag.coded_levels() - 3;
    add_place(dag, level, number);
    add_bits(shared_node(dag, level, number));
    touched_->add_symbols(symbols_of(brick.leaves));
    return brick;
  }
  void clear() {
    nodes_.clear();
    units_.clear();
    bricks_.clear();
  }

 private:
  void add_bits(CompactRange range) {
    touched_->add(kStream, range.begin / 8, (range.end + 7) / 8);
  }
  void add_place(const CompactSvdagView& dag, int level, std::uint64_t number) {
    const std::uint64_t first = 8 * (dag.shared_first[level] + number);
    touched_->add(kSharedBegin, first, first + 16);
  }

  Touched* touched_;
  std::unordered_map<std::uint64_t, CompactNode> nodes_;  // by their first bits
  std::unordered_map<std::uint64_t, CompactUnit> units_;
  std::unordered_map<std::uint32_t, DecodedBrick> bricks_;
};

template <class Nodes, class Finish>
void cast_all(const Nodes& nodes, std::span<const CastRay> casts, const Finish& finish) {
  for (const CastRay& ray : casts) {
    CellHit hit;
    cast(nodes, ray.ray, ray.stop, hit);
    finish();
  }
}

TouchedMemory mean(TouchedMemory sum, std::size_t count) {
  const double rays = static_cast<double>(std::max<std::size_t>(count, 1));
  return {sum.bytes / rays, sum.lines / rays, sum.symbols / rays};
}

}  // namespace

TouchedMemory touched_memory(const SvdagView& dag, std::span<const CastRay> casts) {
  Touched touched;
  TouchedMemory sum;
  cast_all(TouchingNodes(dag, touched), casts, [&] { touched.move_to(sum); });
  return mean(sum, casts.size());
}

TouchedMemory touched_memory(const CompactSvdagView& dag, std::span<const CastRay> casts) {
  Touched touched;
  TouchedMemory sum;
  TouchingCache cache(touched);
  cast_all(CompactSvdagNodes<TouchingCache>(dag, cache), casts, [&] {
    cache.clear();
    touched.move_to(sum);
  });
  return mean(sum, casts.size());
}

}  // namespace voxdag::lab
