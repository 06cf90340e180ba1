#include "voxdag/dag/node_store.hpp"

#include <cstring>
#include <thread>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

class SpinLock {
 public:
  explicit SpinLock(std::atomic_flag& flag) : flag_(flag) {
    for (int spins = 0; flag_.test_and_set(std::memory_order_acquire); ++spins)
      if (spins > 64) std::this_thread::yield();
  }
  ~SpinLock() { flag_.clear(std::memory_order_release); }
  SpinLock(const SpinLock&) = delete;
  SpinLock& operator=(const SpinLock&) = delete;

 private:
  std::atomic_flag& flag_;
};

constexpr std::size_t kFirstSlots = 64;

}  // namespace

std::uint64_t* NodeStore::find(Shard& shard, std::uint64_t* table, std::uint32_t tag,
                               const std::uint32_t* words, int count, std::uint64_t& slot) {
  const std::uint64_t last = table[0];
  for (std::uint64_t i = tag & last;; i = (i + 1) & last) {
    std::uint64_t& here = table[kTableHeader + i];
    // Acquires the words that the slot's writer stored before.
    slot = std::atomic_ref(here).load(std::memory_order_acquire);
    if (slot == 0) return &here;
    if (slot >> 32 != tag) continue;
    const std::uint32_t* stored = shard.at(static_cast<std::uint32_t>(slot) & kOffsetMask);
    // Equal first words mean equal lengths, so that the rest may be read.
    if (stored[0] == words[0] &&
        std::memcmp(stored, words, static_cast<std::size_t>(count) * 4) == 0)
      return &here;
  }
}

NodeId NodeStore::intern(const std::uint32_t* words, int count, std::uint64_t hash) {
  const std::uint32_t shard_index = shard_of(hash), tag = tag_of(hash);
  Shard& shard = shards_[shard_index];
  const auto id_of = [&](std::uint64_t slot) {
    return shard_index << kOffsetBits | (static_cast<std::uint32_t>(slot) & kOffsetMask);
  };
  std::uint64_t slot = 0;
  std::uint64_t* table = shard.table.load(std::memory_order_acquire);
  if (table != nullptr) {
    find(shard, table, tag, words, count, slot);
    if (slot != 0) return id_of(slot);
  }
  const SpinLock guard(shard.lock);
  table = shard.table.load(std::memory_order_relaxed);
  // At most 3/4 full.
  if (table == nullptr || shard.node_count * std::uint64_t{4} >= (table[0] + 1) * 3)
    table = grow(shard);
  std::uint64_t* free = find(shard, table, tag, words, count, slot);
  if (slot != 0) return id_of(slot);
  slot =
      static_cast<std::uint64_t>(tag) << 32 | std::uint64_t{1} << 31 | append(shard, words, count);
  std::atomic_ref(*free).store(slot, std::memory_order_release);
  return id_of(slot);
}

std::uint32_t NodeStore::append(Shard& shard, const std::uint32_t* words, int count) {
  std::uint32_t offset = shard.used_words;
  int chunk = Shard::chunk_of(offset);
  // A node does not straddle chunks.
  if (Shard::chunk_of(offset + static_cast<std::uint32_t>(count) - 1) != chunk)
    offset = Shard::chunk_begin(++chunk);
  if (offset + static_cast<std::uint32_t>(count) > kOffsetMask)
    throw Error("the DAG is too large: one level outgrew 32-bit pointers");
  if (shard.chunks[chunk].size() == 0)
    shard.chunks[chunk] = PageArray<std::uint32_t>(std::size_t{1} << (kFirstChunkBits + chunk));
  std::memcpy(shard.at(offset), words, static_cast<std::size_t>(count) * 4);
  shard.used_words = offset + static_cast<std::uint32_t>(count);
  shard.stored_words += static_cast<std::uint32_t>(count);
  ++shard.node_count;
  budget_->add(static_cast<std::uint64_t>(count) * 4);
  return offset;
}

std::uint64_t* NodeStore::grow(Shard& shard) {
  const std::uint64_t* old = shard.table.load(std::memory_order_relaxed);
  const std::uint64_t slots = old == nullptr ? kFirstSlots : (old[0] + 1) * 2;
  PageArray<std::uint64_t> larger(kTableHeader + slots);
  budget_->add(larger.bytes());
  std::uint64_t* table = larger.data();
  table[0] = slots - 1;
  for (std::uint64_t i = 0; old != nullptr && i <= old[0]; ++i) {
    const std::uint64_t slot = old[kTableHeader + i];
    if (slot == 0) continue;
    std::uint64_t to = (slot >> 32) & (slots - 1);
    while (table[kTableHeader + to] != 0) to = (to + 1) & (slots - 1);
    table[kTableHeader + to] = slot;
  }
  shard.tables.push_back(std::move(larger));
  shard.table.store(table, std::memory_order_release);
  return table;
}

std::uint64_t NodeStore::node_count() const {
  std::uint64_t count = 0;
  for (int i = 0; i < kShards; ++i) count += shards_[i].node_count;
  return count;
}

std::uint64_t NodeStore::word_count() const {
  std::uint64_t count = 0;
  for (int i = 0; i < kShards; ++i) count += shards_[i].stored_words;
  return count;
}

void NodeStore::release_slots() {
  for (int i = 0; i < kShards; ++i) {
    for (const auto& table : shards_[i].tables) budget_->remove(table.bytes());
    shards_[i].tables.clear();
    shards_[i].table.store(nullptr, std::memory_order_relaxed);
  }
}

void NodeStore::release() {
  release_slots();
  for (int i = 0; i < kShards; ++i) {
    Shard& shard = shards_[i];
    budget_->remove(std::uint64_t{shard.stored_words} * 4);
    for (auto& chunk : shard.chunks) PageArray<std::uint32_t>().swap(chunk);
    shard.used_words = shard.stored_words = shard.node_count = 0;
  }
}

}  // namespace voxdag
