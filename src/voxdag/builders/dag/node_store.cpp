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
void touch(PageVector<std::uint64_t>& array) {
  constexpr std::size_t kPage = 4096 / sizeof(std::uint64_t);
  for (std::size_t i = 0; i < array.size(); i += kPage)
    *static_cast<volatile std::uint64_t*>(&array[i]) = 0;
}

}  // namespace

void NodeStore::prefetch_found(std::uint64_t hash) const {
  const NumberSlots table = table_of(hash);
  if (table.slots == nullptr) return;
  std::uint64_t slot = 0;
  table.find(
      NumberSlots::tag_of(hash), [](NodeId) { return true; }, slot);
  if (slot != 0) __builtin_prefetch(words(NumberSlots::number_of(slot)));
}

NodeId NodeStore::intern(const std::uint32_t* words, int count, std::uint64_t hash, Run& run) {
  const std::uint32_t shard_index = shard_of(hash), tag = NumberSlots::tag_of(hash);
  const auto is_equal = [&](NodeId id) {
    const std::uint32_t* stored = this->words(id);
    // If the first words are equal, the lengths are equal, so the other words may be read.
    return stored[0] == words[0] && std::equal(words + 1, words + count, stored + 1);
  };
  std::uint64_t slot = 0;
  const NumberSlots before = table_of(hash);
  if (before.slots != nullptr) {
    before.find(tag, is_equal, slot);
    if (slot != 0) return NumberSlots::number_of(slot);
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
      const NumberSlots table = table_of(hash);
      std::uint64_t* free = table.find(tag, is_equal, slot);
      if (slot != 0) return NumberSlots::number_of(slot);
      const std::uint64_t eighths = (shard.node_count + std::uint64_t{1}) * 8;
      added = eighths <= table.count * kFullEighths;
      if (added) {
        slot = NumberSlots::slot_of(tag, run.next);
        std::atomic_ref(*free).store(slot, std::memory_order_release);
        run.next += static_cast<std::uint32_t>(count);
        shard.word_count += static_cast<std::uint32_t>(count);
        ++shard.node_count;
      }
      if (eighths > table.count * kGrowEighths && !shard.growing) shard.growing = to_grow = true;
    }
    if (to_grow) grow(shard_index);
    if (added) return NumberSlots::number_of(slot);
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
  if (chunk_words * 4 >= kHugePage)
    bytes = std::uint64_t{end_ - chunk_begin(chunk)} * 4 % kHugePage == 0 ? kHugePage : 0;
  MemoryReservation reserved(budget_, bytes);
  if (chunks_[chunk].empty()) chunks_[chunk] = PageVector<std::uint32_t>::zeros(chunk_words);
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
  PageVector<std::uint64_t> larger;
  MemoryReservation reserved;
  try {
    reserved = MemoryReservation(budget_, table_bytes(bits));
    larger = PageVector<std::uint64_t>::zeros(std::size_t{1} << bits);
  } catch (...) {
    const SpinLock guard(shard.lock);
    shard.growing = false;
    throw;
  }
  touch(larger);

  const SpinLock guard(shard.lock);
  if (tables_[shard_index].load(std::memory_order_relaxed) != packed) return;
  reserved.keep();
  if (packed != 0)
    NumberSlots{larger.data(), larger.size()}.add_all(
        {shard.tables.back().data(), shard.tables.back().size()});
  tables_[shard_index].store(reinterpret_cast<std::uint64_t>(larger.data()) | bits,
                             std::memory_order_release);
  if (!shard.tables.empty()) {
    shard.tables.back().discard();
    budget_->release(shard.tables.back().bytes());
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
    if (!tables.empty()) budget_->release(tables.back().bytes());
    tables.clear();
    tables_[i].store(0, std::memory_order_relaxed);
  }
}

void NodeStore::release() {
  release_slots();
  for (int i = 0; i < kShards; ++i) shards_[i].node_count = 0, shards_[i].word_count = 0;
  for (auto& chunk : chunks_) chunk.release();
  budget_->release(std::exchange(word_bytes_, 0));
  end_ = 0;
}

}  // namespace voxdag
