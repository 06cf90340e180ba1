#include "voxdag/builders/dag/node_store.hpp"

#include <algorithm>
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

constexpr int kFirstSlotsBits = 6;

/// The first thread that sees a table with kGrowEighths eighths full grows it. Meanwhile other
/// threads add nodes to it until kFullEighths eighths are full, and then wait.
constexpr std::uint64_t kGrowEighths = 5, kFullEighths = 7;

/// Returns the bytes of a table of 2^bits slots, in whole pages.
std::uint64_t table_bytes(std::uint64_t bits) {
  return std::max(std::uint64_t{4096}, std::uint64_t{8} << bits);
}

/// Makes all pages of an array resident.
void touch(PageArray<std::uint64_t>& array) {
  constexpr std::size_t kPage = 4096 / sizeof(std::uint64_t);
  for (std::size_t i = 0; i < array.size(); i += kPage)
    *static_cast<volatile std::uint64_t*>(&array[i]) = 0;
}

}  // namespace

std::uint64_t* NodeStore::find(const Table& table, std::uint32_t tag, const std::uint32_t* words,
                               int count, std::uint64_t& slot) const {
  for (std::uint64_t i = tag & table.last;; i = (i + 1) & table.last) {
    std::uint64_t& here = table.slots[i];
    // Acquires the words that the slot's writer stored before the slot.
    slot = std::atomic_ref(here).load(std::memory_order_acquire);
    if (slot == 0) return &here;
    if (slot >> 32 != tag) continue;
    const std::uint32_t* stored = this->words(static_cast<std::uint32_t>(slot) - 1);
    // If the first words are equal, the lengths are equal, so the other words may be read.
    if (stored[0] == words[0] && std::equal(words + 1, words + count, stored + 1)) return &here;
  }
}

void NodeStore::prefetch_found(std::uint64_t hash) const {
  const Table table = table_of(hash);
  if (table.slots == nullptr) return;
  constexpr std::uint64_t kProbes = 4;
  for (std::uint64_t i = 0; i < kProbes; ++i) {
    std::uint64_t& here = table.slots[(tag_of(hash) + i) & table.last];
    const std::uint64_t slot = std::atomic_ref(here).load(std::memory_order_acquire);
    if (slot == 0) return;
    if (slot >> 32 != tag_of(hash)) continue;
    __builtin_prefetch(words(static_cast<std::uint32_t>(slot) - 1));
    return;
  }
}

NodeId NodeStore::intern(const std::uint32_t* words, int count, std::uint64_t hash, Run& run) {
  const std::uint32_t shard_index = shard_of(hash), tag = tag_of(hash);
  const auto id_of = [](std::uint64_t slot) { return static_cast<NodeId>(slot) - 1; };
  std::uint64_t slot = 0;
  const Table before = table_of(hash);
  if (before.slots != nullptr) {
    find(before, tag, words, count, slot);
    if (slot != 0) return id_of(slot);
  } else {
    grow(shard_index);
  }
  if (run.end - run.next < static_cast<std::uint32_t>(count)) take_run(run);
  std::memcpy(this->words(run.next), words, static_cast<std::size_t>(count) * 4);

  Shard& shard = shards_[shard_index];
  for (;;) {
    bool added = false, to_grow = false;
    {
      const SpinLock guard(shard.lock);
      const Table table = table_of(hash);
      std::uint64_t* free = find(table, tag, words, count, slot);
      if (slot != 0) return id_of(slot);
      const std::uint64_t eighths = (shard.node_count + std::uint64_t{1}) * 8;
      const std::uint64_t slots = table.last + 1;
      added = eighths <= slots * kFullEighths;
      if (added) {
        slot = static_cast<std::uint64_t>(tag) << 32 | (run.next + 1);
        std::atomic_ref(*free).store(slot, std::memory_order_release);
        run.next += static_cast<std::uint32_t>(count);
        shard.word_count += static_cast<std::uint32_t>(count);
        ++shard.node_count;
      }
      if (eighths > slots * kGrowEighths && !shard.growing) shard.growing = to_grow = true;
    }
    if (to_grow) grow(shard_index);
    if (added) return id_of(slot);
    if (!to_grow) std::this_thread::yield();
  }
}

void NodeStore::take_run(Run& run) {
  const std::lock_guard guard(runs_mutex_);
  const int chunk = chunk_of(end_);
  const int bits = std::min(kFirstChunkBits + chunk - kRunsBits, kMaxRunBits);
  const std::uint32_t words = 1u << bits;
  // The last id plus one must fit in a slot.
  if (end_ > kNoNode - words)
    throw Error("the DAG is too large: one level has more words than 32-bit pointers can address");
  const std::size_t chunk_words = std::size_t{1} << (kFirstChunkBits + chunk);
  std::uint64_t bytes = std::uint64_t{words} * 4;
  // Large chunks become resident in whole huge pages.
  if (chunk_words * 4 >= PageArray<std::uint32_t>::kHugePage)
    bytes = std::uint64_t{end_ - chunk_begin(chunk)} * 4 % PageArray<std::uint32_t>::kHugePage == 0
                ? PageArray<std::uint32_t>::kHugePage
                : 0;
  MemoryReservation reserved(budget_, bytes);
  if (chunks_[chunk].size() == 0) chunks_[chunk] = PageArray<std::uint32_t>(chunk_words);
  reserved.keep();
  run = {end_, end_ + words};
  end_ += words;
  word_bytes_ += bytes;
}

/// Gives a shard its first table, or one twice as large. Several threads may make a first table at
/// the same time; one of the tables is used.
void NodeStore::grow(std::uint32_t shard_index) {
  Shard& shard = shards_[shard_index];
  const std::uint64_t packed = tables_[shard_index].load(std::memory_order_acquire);
  const std::uint64_t bits = packed == 0 ? kFirstSlotsBits : (packed & 63) + 1;
  PageArray<std::uint64_t> larger;
  MemoryReservation reserved;
  try {
    reserved = MemoryReservation(budget_, table_bytes(bits));
    larger = PageArray<std::uint64_t>(std::size_t{1} << bits);
  } catch (...) {
    const SpinLock guard(shard.lock);
    shard.growing = false;
    throw;
  }
  touch(larger);

  const SpinLock guard(shard.lock);
  if (tables_[shard_index].load(std::memory_order_relaxed) != packed) return;
  reserved.keep();
  const std::uint64_t last = larger.size() - 1;
  if (packed != 0) {
    const auto* old = reinterpret_cast<const std::uint64_t*>(packed & ~std::uint64_t{63});
    for (std::uint64_t i = 0; i <= last / 2; ++i) {
      if (old[i] == 0) continue;
      std::uint64_t to = (old[i] >> 32) & last;
      while (larger[to] != 0) to = (to + 1) & last;
      larger[to] = old[i];
    }
  }
  tables_[shard_index].store(reinterpret_cast<std::uint64_t>(larger.data()) | bits,
                             std::memory_order_release);
  if (!shard.tables.empty()) {
    shard.tables.back().discard();
    budget_->release(shard.tables.back().mapped_bytes());
  }
  shard.tables.push_back(std::move(larger));
  shard.growing = false;
}

std::uint64_t NodeStore::node_count() const {
  std::uint64_t count = 0;
  for (int i = 0; i < kShards; ++i) count += shards_[i].node_count;
  return count;
}

std::uint64_t NodeStore::word_count() const {
  std::uint64_t count = 0;
  for (int i = 0; i < kShards; ++i) count += shards_[i].word_count;
  return count;
}

void NodeStore::release_slots() {
  for (int i = 0; i < kShards; ++i) {
    auto& tables = shards_[i].tables;
    if (!tables.empty()) budget_->release(tables.back().mapped_bytes());
    tables.clear();
    tables_[i].store(0, std::memory_order_relaxed);
  }
}

void NodeStore::release() {
  release_slots();
  for (int i = 0; i < kShards; ++i) shards_[i].node_count = 0, shards_[i].word_count = 0;
  for (auto& chunk : chunks_) PageArray<std::uint32_t>().swap(chunk);
  budget_->release(std::exchange(word_bytes_, 0));
  end_ = 0;
}

}  // namespace voxdag
