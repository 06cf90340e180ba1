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

NodeId NodeStore::intern(const std::uint32_t* words, int count) {
  const std::uint64_t hash = hash_words(words, count);
  const std::uint32_t shard_index = static_cast<std::uint32_t>(hash >> (64 - (32 - kOffsetBits)));
  const std::uint32_t tag = static_cast<std::uint32_t>(hash);
  Shard& shard = shards_[shard_index];
  const SpinLock guard(shard.lock);
  // At most 3/4 full.
  if (shard.node_count * std::uint64_t{4} >= shard.slots.size() * 3) grow(shard);
  const std::size_t last = shard.slots.size() - 1;
  for (std::size_t i = tag & last;; i = (i + 1) & last) {
    std::uint64_t& slot = shard.slots[i];
    if (slot == 0) {
      const NodeId id = append(shard, shard_index, words, count);
      slot = static_cast<std::uint64_t>(tag) << 32 | (id & kOffsetMask) | std::uint64_t{1} << 31;
      return id;
    }
    if (slot >> 32 != tag) continue;
    const std::uint32_t offset = static_cast<std::uint32_t>(slot) & kOffsetMask;
    const std::uint32_t* stored = shard.at(offset);
    // Equal first words mean equal lengths, so that the rest may be read.
    if (stored[0] == words[0] &&
        std::memcmp(stored, words, static_cast<std::size_t>(count) * 4) == 0)
      return shard_index << kOffsetBits | offset;
  }
}

NodeId NodeStore::append(Shard& shard, std::uint32_t shard_index, const std::uint32_t* words,
                         int count) {
  std::uint32_t offset = shard.used_words;
  int chunk = Shard::chunk_of(offset);
  // A node does not straddle chunks.
  if (Shard::chunk_of(offset + static_cast<std::uint32_t>(count) - 1) != chunk)
    offset = Shard::chunk_begin(++chunk);
  if (offset + static_cast<std::uint32_t>(count) > kOffsetMask)
    throw Error("the DAG is too large: one level outgrew 32-bit pointers");
  if (shard.chunks[chunk].size() == 0) {
    shard.chunks[chunk] = PageArray<std::uint32_t>(std::size_t{1} << (kFirstChunkBits + chunk));
  }
  std::memcpy(shard.at(offset), words, static_cast<std::size_t>(count) * 4);
  shard.used_words = offset + static_cast<std::uint32_t>(count);
  shard.stored_words += static_cast<std::uint32_t>(count);
  ++shard.node_count;
  budget_->add(static_cast<std::uint64_t>(count) * 4);
  return shard_index << kOffsetBits | offset;
}

void NodeStore::grow(Shard& shard) {
  PageArray<std::uint64_t> larger(shard.slots.size() == 0 ? kFirstSlots : shard.slots.size() * 2);
  budget_->add(larger.bytes());
  const std::size_t last = larger.size() - 1;
  for (std::size_t i = 0; i < shard.slots.size(); ++i) {
    const std::uint64_t slot = shard.slots[i];
    if (slot == 0) continue;
    std::size_t to = static_cast<std::size_t>(slot >> 32) & last;
    while (larger[to] != 0) to = (to + 1) & last;
    larger[to] = slot;
  }
  budget_->remove(shard.slots.bytes());
  shard.slots = std::move(larger);
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
    budget_->remove(shards_[i].slots.bytes());
    PageArray<std::uint64_t>().swap(shards_[i].slots);
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
