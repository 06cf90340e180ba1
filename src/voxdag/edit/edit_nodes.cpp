#include "voxdag/edit/edit_nodes.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "voxdag/core/checked_size.hpp"
#include "voxdag/core/io/pages.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"

namespace voxdag {
namespace {

/// Memory is counted in the steps in which it becomes resident.
constexpr std::uint64_t kStep = kHugePage;
constexpr std::uint64_t kMaxBlocks = 0xFFFFFFFFull;
/// The sizes of the runs of words and blocks that a writer takes.
constexpr std::uint32_t kRunWords = 1024, kRunBlocks = 512;
/// 32-bit pointers address no more nodes, or the memory of a browser ends.
constexpr char kNoRoom[] = "there is no room for more edits: save the scene and open it again";

std::uint64_t rounded_up(std::uint64_t bytes) { return (bytes + kStep - 1) / kStep * kStep; }

template <class T>
void copy_in_parts(const T* from, std::uint64_t count, T* to) {
  constexpr std::uint64_t kPart = 1 << 20;
  parallel_for((count + kPart - 1) / kPart, [&](std::size_t part) {
    const std::uint64_t first = part * kPart;
    std::memcpy(to + first, from + first, std::min(kPart, count - first) * sizeof(T));
  });
}

/// Shortens a run to end at `end`, if it reaches beyond.
void trim_run(EditRun& run, std::uint64_t end) {
  if (run.first + run.count > end) run.count = end > run.first ? end - run.first : 0;
}

}  // namespace

EditNodes::EditNodes(const SvdagView& base, Work work) : work_(work) {
  if (base.node_words() > kMaxPlainWords)
    throw Error("the DAG is too large to edit: its nodes have more than 2^32 words");
  assert(base.root == 0);
  words_ = PageVector<std::uint32_t>::zeros(
      checked_size(bytes_to_map(4 * base.node_words(), 4 * kMaxPlainWords) / 4));
  blocks_ = PageVector<std::uint64_t>::zeros(
      checked_size(bytes_to_map(8 * base.leaf_block_count, 8 * kMaxBlocks) / 8));
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
    tables_.push_back(std::make_unique<SharedNumberTable>(work.memory));
    base_numbers_.emplace_back(base_, level, work);
  }
}

bool EditNodes::is_minimal() const {
  return std::all_of(base_numbers_.begin(), base_numbers_.end(),
                     [](const BaseNumbers& numbers) { return numbers.is_minimal(); });
}

SvdagView EditNodes::view(std::uint32_t root) const {
  SvdagView view = base_;
  view.root = root == kNone ? 0 : root;
  view.leaf_block_count = root == kNone ? 0 : blocks_end_;
  return view;
}

EditNodes::Writer::~Writer() {
  nodes_.give_back_words(words_);
  nodes_.give_back_blocks(blocks_);
}

EditNodes::Writer::Pending EditNodes::Writer::node_of(const std::uint32_t (&children)[8]) {
  Pending node;
  node.words[0] = 0;
  std::uint32_t count = 1;
  for (std::uint32_t i = 0; i < 8; ++i) {
    if (children[i] == kNone) continue;
    node.words[0] |= 1u << i;
    node.words[count++] = children[i];
  }
  if (count == 1) return node;
  node.count = count;
  node.hash = hash_words(node.words, static_cast<int>(count));
  return node;
}

EditNodes::Writer::Pending EditNodes::Writer::block_of(std::uint64_t voxels) {
  Pending node;
  node.words[0] = static_cast<std::uint32_t>(voxels);
  node.words[1] = static_cast<std::uint32_t>(voxels >> 32);
  if (voxels == 0) return node;
  node.count = 2;
  node.hash = hash_words(node.words, 2);
  return node;
}

void EditNodes::Writer::prefetch(int level, const Pending& node) const {
  nodes_.base_numbers_[static_cast<std::size_t>(level)].prefetch(node.hash);
  nodes_.tables_[static_cast<std::size_t>(level)]->prefetch(node.hash);
}

void EditNodes::Writer::prefetch_found(int level, const Pending& node) const {
  const auto l = static_cast<std::size_t>(level);
  std::uint32_t number = 0;
  if (!nodes_.base_numbers_[l].find(
          node.hash, [](std::uint32_t) { return true; }, number) &&
      !nodes_.tables_[l]->find_tag(node.hash, number))
    return;
  if (level == nodes_.levels() - 2)
    __builtin_prefetch(nodes_.address(number));
  else
    __builtin_prefetch(nodes_.words(number));
}

std::uint32_t EditNodes::Writer::intern(int level, const Pending& node) {
  if (node.count == 0) return kNone;
  const bool is_leaf = level == nodes_.levels() - 2;
  const std::uint64_t voxels = node.words[0] | std::uint64_t{node.words[1]} << 32;
  const auto is_equal = [&](std::uint32_t number) {
    if (is_leaf) return nodes_.block(number) == voxels;
    const std::uint32_t* const stored = nodes_.words(number);
    // If the first words are equal, the lengths are equal, so the other words may be read.
    return stored[0] == node.words[0] &&
           std::equal(node.words + 1, node.words + node.count, stored + 1);
  };
  std::uint32_t found = 0;
  if (nodes_.base_numbers_[static_cast<std::size_t>(level)].find(node.hash, is_equal, found))
    return found;
  SharedNumberTable& table = *nodes_.tables_[static_cast<std::size_t>(level)];
  if (is_leaf)
    return table.find_or_add(
        node.hash, 1, is_equal,
        [&] {
          if (blocks_.next == blocks_.end) nodes_.take_blocks(blocks_);
          nodes_.blocks_[blocks_.next] = voxels;
          return blocks_.next;
        },
        [&] { ++blocks_.next; });
  return table.find_or_add(
      node.hash, node.count, is_equal,
      [&] {
        if (words_.end - words_.next < node.count) nodes_.take_words(words_, node.count);
        std::memcpy(nodes_.words_.data() + words_.next, node.words, node.count * 4);
        return words_.next;
      },
      [&] { words_.next += node.count; });
}

void EditNodes::add_full() {
  if (full(0) != kNone) return;
  Writer writer(*this);
  std::uint32_t node = writer.intern_block(~std::uint64_t{0});
  full_[static_cast<std::size_t>(levels() - 2)] = node;
  for (int level = levels() - 3; level >= 0; --level) {
    std::uint32_t children[8];
    std::fill_n(children, 8, node);
    full_[static_cast<std::size_t>(level)] = node = writer.intern(level, children);
  }
}

void EditNodes::FreeRuns::add(Run run) {
  if (run.next == run.end) return;
  lists[std::min(9u, run.end - run.next)].push_back(run);
  count += run.end - run.next;
}

EditNodes::Run EditNodes::FreeRuns::take(std::uint32_t least, std::uint32_t most, Run& rest) {
  for (std::size_t size = least; size < lists.size(); ++size) {
    if (lists[size].empty()) continue;
    Run run = lists[size].back();
    lists[size].pop_back();
    count -= run.end - run.next;
    if (run.end - run.next > most) {
      rest = {run.next + most, run.end};
      run.end = rest.next;
    }
    return run;
  }
  return {};
}

void EditNodes::free_words(Run run) {
  if (run.next == run.end) return;
  words_[run.next] = kUnused + (run.end - run.next);
  free_words_.add(run);
}

void EditNodes::take_words(Run& run, std::uint32_t count) {
  give_back_words(run);
  const std::lock_guard guard(mutex_);
  Run rest;
  run = free_words_.take(count, kRunWords, rest);
  free_words(rest);
  if (run.next == run.end) {
    if (words_end_ + kRunWords > words_.size()) throw Error(kNoRoom);
    count_memory(words_end_ + kRunWords, blocks_end_);
    const auto begin = static_cast<std::uint32_t>(words_end_);
    run = {begin, begin + kRunWords};
    words_end_ += kRunWords;
  }
  if (tracks_changes_) note_run(changes_.words, run.next, run.end - run.next);
}

void EditNodes::take_blocks(Run& run) {
  const std::lock_guard guard(mutex_);
  Run rest;
  run = free_blocks_.take(1, kRunBlocks, rest);
  free_blocks_.add(rest);
  if (run.next == run.end) {
    if (blocks_end_ + kRunBlocks > blocks_.size()) throw Error(kNoRoom);
    count_memory(words_end_, blocks_end_ + kRunBlocks);
    const auto begin = static_cast<std::uint32_t>(blocks_end_);
    run = {begin, begin + kRunBlocks};
    blocks_end_ += kRunBlocks;
  }
  if (tracks_changes_) note_run(changes_.blocks, run.next, run.end - run.next);
}

void EditNodes::give_back_words(Run& run) {
  if (run.next == run.end) return;
  const std::lock_guard guard(mutex_);
  if (run.end == words_end_) {
    words_end_ = run.next;
    if (!changes_.words.empty()) trim_run(changes_.words.back(), words_end_);
  } else {
    free_words(run);
  }
  run = {};
}

void EditNodes::give_back_blocks(Run& run) {
  if (run.next == run.end) return;
  const std::lock_guard guard(mutex_);
  if (run.end == blocks_end_) {
    blocks_end_ = run.next;
    if (!changes_.blocks.empty()) trim_run(changes_.blocks.back(), blocks_end_);
  } else {
    free_blocks_.add(run);
  }
  run = {};
}

std::uint64_t EditNodes::added_nodes() const {
  std::uint64_t count = collected_nodes_;
  for (const auto& table : tables_) count += table->count();
  return count;
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
  for (int i = 1; i < words_of_node(words(node)); ++i) mark(level + 1, words(node)[i]);
}

bool EditNodes::is_marked(int level, std::uint32_t node) const {
  const bool is_leaf = level == levels() - 2;
  const std::uint64_t base = is_leaf ? base_.leaf_block_count : base_.node_words();
  return node == kNone || node < base || (is_leaf ? block_marks_ : word_marks_)[node - base];
}

void EditNodes::collect(std::span<const std::uint32_t> roots) {
  const std::uint64_t first_word = base_.node_words(), first_block = base_.leaf_block_count;
  word_marks_.assign(words_end_ - first_word, false);
  block_marks_.assign(blocks_end_ - first_block, false);
  for (const std::uint32_t root : roots) mark(0, root);
  const std::uint64_t nodes_before = added_nodes();
  for (int level = 0; level < levels() - 1; ++level) {
    if (!is_marked(level, full(level))) full_.fill(kNone);
    tables_[static_cast<std::size_t>(level)]->retain(
        [&](std::uint32_t number) { return is_marked(level, number); });
  }
  collected_nodes_ += nodes_before - added_nodes();
  free_words_ = {};
  Run unused;
  for (std::uint64_t at = first_word; at <= words_end_;) {
    const bool is_end = at == words_end_;
    if (is_end || word_marks_[at - first_word]) {
      free_words(unused);
      unused = {};
    }
    if (is_end) break;
    const std::uint32_t first = words_[at];
    const std::uint32_t count =
        first > kUnused ? first - kUnused : static_cast<std::uint32_t>(words_of_node(&first));
    if (!word_marks_[at - first_word]) {
      if (unused.next == unused.end) unused.next = static_cast<std::uint32_t>(at);
      unused.end = static_cast<std::uint32_t>(at) + count;
    }
    at += count;
    assert(at <= words_end_);
  }
  free_blocks_ = {};
  unused = {};
  for (std::uint64_t at = first_block; at <= blocks_end_; ++at) {
    if (at < blocks_end_ && !block_marks_[at - first_block]) {
      if (unused.next == unused.end) unused.next = static_cast<std::uint32_t>(at);
      unused.end = static_cast<std::uint32_t>(at) + 1;
      continue;
    }
    free_blocks_.add(unused);
    unused = {};
  }
  word_marks_ = {};
  block_marks_ = {};
}

}  // namespace voxdag
