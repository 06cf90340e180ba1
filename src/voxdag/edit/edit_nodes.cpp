#include "voxdag/edit/edit_nodes.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstring>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"

namespace voxdag {
namespace {

/// Memory is counted in the steps in which it becomes resident.
constexpr std::uint64_t kStep = kHugePage;
constexpr std::uint64_t kMaxBlocks = 0xFFFFFFFFull;
/// The base is hashed in parts of about this many words.
constexpr std::uint64_t kPartWords = 1 << 16;

std::uint64_t rounded_up(std::uint64_t bytes) { return (bytes + kStep - 1) / kStep * kStep; }

template <class T>
void copy_in_parts(const T* from, std::uint64_t count, T* to) {
  constexpr std::uint64_t kPart = 1 << 20;
  parallel_for((count + kPart - 1) / kPart, [&](std::size_t part) {
    const std::uint64_t first = part * kPart;
    std::memcpy(to + first, from + first, std::min(kPart, count - first) * sizeof(T));
  });
}

std::uint64_t hash_block(std::uint64_t voxels) {
  const std::uint32_t words[] = {static_cast<std::uint32_t>(voxels),
                                 static_cast<std::uint32_t>(voxels >> 32)};
  return hash_words(words, 2);
}

int words_of(const std::uint32_t* node) { return 1 + popcount(child_mask(node)); }

/// Adds a number to a table that other threads fill, too.
void add_shared(const NumberSlots& table, std::uint64_t hash, std::uint32_t number) {
  const std::uint32_t tag = NumberSlots::tag_of(hash);
  const std::uint64_t slot = NumberSlots::slot_of(tag, number);
  for (std::uint64_t i = table.first_of(tag);; i = table.next(i)) {
    std::uint64_t free = 0;
    if (std::atomic_ref(table.slots[i])
            .compare_exchange_strong(free, slot, std::memory_order_relaxed))
      return;
  }
}

/// Calls hash_of(i) for all i in [0, count), and adds numbers and hashes to a table. Slots are
/// loaded some items ahead, because each is a cache miss.
class SlotFiller {
 public:
  explicit SlotFiller(const NumberSlots& table) : table_(table) {}
  void add(std::uint64_t hash, std::uint32_t number) {
    Waiting& place = waiting_[next_ % kAhead];
    if (next_ >= kAhead) add_shared(table_, place.hash, place.number);
    place = {hash, number};
    ++next_;
    __builtin_prefetch(table_.slots + table_.first_of(NumberSlots::tag_of(hash)), 1);
  }
  void finish() {
    for (std::uint64_t i = next_ - std::min<std::uint64_t>(next_, kAhead); i < next_; ++i)
      add_shared(table_, waiting_[i % kAhead].hash, waiting_[i % kAhead].number);
  }

 private:
  static constexpr std::uint64_t kAhead = 16;
  struct Waiting {
    std::uint64_t hash = 0;
    std::uint32_t number = 0;
  };
  NumberSlots table_;
  std::array<Waiting, kAhead> waiting_{};
  std::uint64_t next_ = 0;
};

}  // namespace

EditNodes::EditNodes(const SvdagView& base, Work work) : work_(work) {
  if (base.node_words() > kMaxPlainWords)
    throw Error("the DAG is too large to edit: its nodes have more than 2^32 words");
  assert(base.root == 0);
  words_ = PageVector<std::uint32_t>::zeros(kMaxPlainWords);
  blocks_ = PageVector<std::uint64_t>::zeros(kMaxBlocks);
  count_memory(base.node_words(), base.leaf_block_count);
  copy_in_parts(base.nodes, base.node_words(), words_.data());
  copy_in_parts(base.leaf_blocks, base.leaf_block_count, blocks_.data());
  base_ = base;
  base_.nodes = words_.data();
  base_.leaf_blocks = blocks_.data();
  words_end_ = base.node_words();
  blocks_end_ = base.leaf_block_count;
  full_.fill(kNone);
  for (int level = 0; level <= base.levels - 2; ++level) {
    tables_.emplace_back(work.memory);
    hash_base(level);
  }
}

EditNodes::~EditNodes() {
  if (work_.memory == nullptr) return;
  for (const auto& slots : base_slots_) work_.memory->release(slots.bytes());
}

void EditNodes::hash_base(int level) {
  // Finds the nodes where parts begin, and counts nodes.
  std::vector<std::uint64_t> parts;
  std::uint64_t nodes = 0;
  const bool is_leaf = level == levels() - 2;
  const std::uint64_t begin = is_leaf ? 0 : base_.level_begin[level],
                      end = is_leaf ? base_.leaf_block_count : base_.level_begin[level + 1];
  if (is_leaf) {
    nodes = end;
    for (std::uint64_t at = 0; at < end; at += kPartWords) parts.push_back(at);
  } else {
    std::uint64_t next = begin;
    for (std::uint64_t at = begin; at < end; ++nodes) {
      if (at >= next) {
        parts.push_back(at);
        next = at + kPartWords;
      }
      at += static_cast<std::uint64_t>(words_of(base_.nodes + at));
    }
  }
  parts.push_back(end);
  const std::size_t slots = nodes + nodes / 2 + 1;
  if (work_.memory != nullptr) work_.memory->reserve((slots * 8 + 4095) / 4096 * 4096);
  base_slots_.push_back(PageVector<std::uint64_t>::zeros(slots));
  const NumberSlots table{base_slots_.back().data(), slots};
  parallel_for(parts.size() - 1, [&](std::size_t part) {
    work_.poll();
    SlotFiller filler(table);
    for (std::uint64_t at = parts[part]; at < parts[part + 1];) {
      const auto number = static_cast<std::uint32_t>(at);
      if (is_leaf) {
        filler.add(hash_block(base_.leaf_blocks[at++]), number);
      } else {
        const int count = words_of(base_.nodes + at);
        filler.add(hash_words(base_.nodes + at, count), number);
        at += static_cast<std::uint64_t>(count);
      }
    }
    filler.finish();
  });
}

SvdagView EditNodes::view(std::uint32_t root) const {
  SvdagView view = base_;
  view.root = root == kNone ? 0 : root;
  view.leaf_block_count = root == kNone ? 0 : blocks_end_;
  return view;
}

template <class IsEqual, class Add>
std::uint32_t EditNodes::find_or_add(int level, std::uint64_t hash, const IsEqual& is_equal,
                                     const Add& add) {
  PageVector<std::uint64_t>& slots = base_slots_[static_cast<std::size_t>(level)];
  std::uint64_t found = 0;
  NumberSlots{slots.data(), slots.size()}.find(NumberSlots::tag_of(hash), is_equal, found);
  if (found != 0) return NumberSlots::number_of(found);
  return tables_[static_cast<std::size_t>(level)].find_or_add(hash, is_equal, add);
}

std::uint32_t EditNodes::intern(int level, const std::uint32_t (&children)[8]) {
  std::uint32_t node[9];
  std::uint32_t count = 1;
  node[0] = 0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    if (children[i] == kNone) continue;
    node[0] |= 1u << i;
    node[count++] = children[i];
  }
  if (count == 1) return kNone;
  return find_or_add(
      level, hash_words(node, static_cast<int>(count)),
      [&](std::uint32_t number) {
        const std::uint32_t* const stored = words(number);
        return stored[0] == node[0] && std::equal(node + 1, node + count, stored + 1);
      },
      [&] { return add_words(node, count); });
}

std::uint32_t EditNodes::intern_block(std::uint64_t voxels) {
  if (voxels == 0) return kNone;
  return find_or_add(
      levels() - 2, hash_block(voxels),
      [&](std::uint32_t number) { return block(number) == voxels; },
      [&] { return add_block(voxels); });
}

std::uint32_t EditNodes::full(int level) {
  std::uint32_t& node = full_[static_cast<std::size_t>(level)];
  if (node != kNone) return node;
  if (level == levels() - 2) return node = intern_block(~std::uint64_t{0});
  std::uint32_t children[8];
  std::fill_n(children, 8, full(level + 1));
  return node = intern(level, children);
}

std::uint32_t EditNodes::add_words(const std::uint32_t* words, std::uint32_t count) {
  std::uint32_t at = 0;
  if (auto& free = free_words_[count]; !free.empty()) {
    at = free.back();
    free.pop_back();
    unused_words_ -= count;
  } else {
    if (words_end_ + count > kMaxPlainWords)
      throw Error(
          "the DAG is too large: its nodes have more words than 32-bit pointers can address");
    count_memory(words_end_ + count, blocks_end_);
    at = static_cast<std::uint32_t>(words_end_);
    words_end_ += count;
  }
  std::memcpy(words_.data() + at, words, count * sizeof(std::uint32_t));
  note_run(changes_.words, at, count);
  ++added_nodes_;
  return at;
}

std::uint32_t EditNodes::add_block(std::uint64_t voxels) {
  std::uint32_t at = 0;
  if (!free_blocks_.empty()) {
    at = free_blocks_.back();
    free_blocks_.pop_back();
  } else {
    if (blocks_end_ == kMaxBlocks)
      throw Error("the DAG is too large: it has more leaf blocks than 32-bit pointers can address");
    count_memory(words_end_, blocks_end_ + 1);
    at = static_cast<std::uint32_t>(blocks_end_++);
  }
  blocks_[at] = voxels;
  note_run(changes_.blocks, at, 1);
  ++added_nodes_;
  return at;
}

void EditNodes::count_memory(std::uint64_t words_end, std::uint64_t blocks_end) {
  const std::uint64_t bytes = rounded_up(words_end * 4) + rounded_up(blocks_end * 8);
  if (bytes <= memory_.bytes()) return;
  if (memory_.bytes() == 0)
    memory_ = MemoryReservation(work_.memory, bytes);
  else
    memory_.resize(bytes);
}

void EditNodes::mark(int level, std::uint32_t node) {
  if (node == kNone) return;
  const bool is_leaf = level == levels() - 2;
  const std::uint64_t base = is_leaf ? base_.leaf_block_count : base_.node_words();
  if (node < base) return;
  const auto bit = (is_leaf ? block_marks_ : word_marks_)[node - base];
  if (bit) return;
  (is_leaf ? block_marks_ : word_marks_)[node - base] = true;
  if (is_leaf) return;
  for (int i = 1; i < words_of(words(node)); ++i) mark(level + 1, words(node)[i]);
}

bool EditNodes::is_marked(int level, std::uint32_t node) const {
  const bool is_leaf = level == levels() - 2;
  const std::uint64_t base = is_leaf ? base_.leaf_block_count : base_.node_words();
  return node < base || (is_leaf ? block_marks_ : word_marks_)[node - base];
}

void EditNodes::collect(std::span<const std::uint32_t> roots) {
  const std::uint64_t first_word = base_.node_words(), first_block = base_.leaf_block_count;
  word_marks_.assign(words_end_ - first_word, false);
  block_marks_.assign(blocks_end_ - first_block, false);
  for (const std::uint32_t root : roots) mark(0, root);
  for (int level = 0; level < levels() - 1; ++level) {
    if (std::uint32_t& full = full_[static_cast<std::size_t>(level)];
        full != kNone && !is_marked(level, full))
      full = kNone;
    tables_[static_cast<std::size_t>(level)].retain(
        [&](std::uint32_t number) { return is_marked(level, number); });
  }
  for (auto& free : free_words_) free.clear();
  unused_words_ = 0;
  for (std::uint64_t at = first_word; at < words_end_;) {
    std::uint32_t& first = words_[at];
    const std::uint32_t count =
        first > kUnused ? first - kUnused : static_cast<std::uint32_t>(words_of(&first));
    if (!word_marks_[at - first_word]) {
      first = kUnused + count;
      free_words_[count].push_back(static_cast<std::uint32_t>(at));
      unused_words_ += count;
    }
    at += count;
  }
  free_blocks_.clear();
  for (std::uint64_t at = first_block; at < blocks_end_; ++at)
    if (!block_marks_[at - first_block]) free_blocks_.push_back(static_cast<std::uint32_t>(at));
  word_marks_ = {};
  block_marks_ = {};
}

}  // namespace voxdag
