#include "voxdag/edit/base_numbers.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// Nodes are hashed in parts of about this many words or leaf blocks.
constexpr std::uint64_t kHashedWords = 1 << 16;

/// Adds numbers by their hashes to a table that other threads fill, too. Slots are loaded some
/// items ahead, because each is a cache miss.
template <class IsEqual>
class SlotFiller {
 public:
  SlotFiller(const NumberSlots& table, const IsEqual& is_equal)
      : table_(table), is_equal_(is_equal) {}
  void add(std::uint64_t hash, std::uint64_t number) {
    Waiting& place = waiting_[next_ % kAhead];
    if (next_ >= kAhead) add_shared(place);
    place = {NumberSlots::tag_of(hash), static_cast<std::uint32_t>(number)};
    ++next_;
    __builtin_prefetch(table_.slots + table_.first_of(place.tag), 1);
  }
  void finish() {
    for (std::uint64_t i = next_ - std::min<std::uint64_t>(next_, kAhead); i < next_; ++i)
      add_shared(waiting_[i % kAhead]);
  }
  /// Returns whether an item is equal to one that was there before.
  bool has_equal() const { return has_equal_; }

 private:
  static constexpr std::uint64_t kAhead = 16;
  struct Waiting {
    std::uint32_t tag = 0, number = 0;
  };

  void add_shared(const Waiting& item) {
    const std::uint64_t slot = NumberSlots::slot_of(item.tag, item.number);
    for (std::uint64_t i = table_.first_of(item.tag);; i = table_.next(i)) {
      std::uint64_t free = 0;
      if (std::atomic_ref(table_.slots[i])
              .compare_exchange_strong(free, slot, std::memory_order_relaxed))
        return;
      has_equal_ |= free >> 32 == item.tag && is_equal_(item.number, NumberSlots::number_of(free));
    }
  }

  NumberSlots table_;
  const IsEqual& is_equal_;
  bool has_equal_ = false;
  std::array<Waiting, kAhead> waiting_{};
  std::uint64_t next_ = 0;
};

}  // namespace

BaseNumbers::BaseNumbers(const SvdagView& dag, int level, Work work) {
  const bool is_leaf = level == dag.levels - 2;
  const std::uint64_t begin = is_leaf ? 0 : dag.level_begin[level],
                      end = is_leaf ? dag.leaf_block_count : dag.level_begin[level + 1];
  const auto size_at = [&](std::uint64_t at) {
    return is_leaf ? 1 : static_cast<std::uint64_t>(words_of_node(dag.nodes + at));
  };
  // Finds the nodes where parts begin, and counts nodes.
  std::vector<std::uint64_t> parts;
  std::uint64_t nodes = 0;
  for (std::uint64_t at = begin; at < end; at += size_at(at), ++nodes)
    if (parts.empty() || at >= parts.back() + kHashedWords) parts.push_back(at);
  parts.push_back(end);
  const std::size_t slots = nodes + nodes / 2 + 1;
  memory_ = MemoryReservation(work.memory, slots * sizeof(std::uint64_t));
  slots_ = PageVector<std::uint64_t>::zeros(slots);
  const auto is_equal = [&](std::uint32_t a, std::uint32_t b) {
    if (is_leaf) return dag.leaf_blocks[a] == dag.leaf_blocks[b];
    const std::uint32_t* const words = dag.nodes + a;
    return std::equal(words, words + words_of_node(words), dag.nodes + b);
  };
  std::atomic<bool> has_equal = false;
  parallel_for(parts.size() - 1, [&](std::size_t part) {
    work.poll();
    SlotFiller filler(table(), is_equal);
    for (std::uint64_t at = parts[part]; at < parts[part + 1]; at += size_at(at))
      filler.add(is_leaf ? hash_block(dag.leaf_blocks[at])
                         : hash_words(dag.nodes + at, words_of_node(dag.nodes + at)),
                 at);
    filler.finish();
    if (filler.has_equal()) has_equal = true;
  });
  is_minimal_ = !has_equal;
}

}  // namespace voxdag
