#include "voxdag/core/shared_number_table.hpp"

#include <algorithm>
#include <bit>
#include <thread>
#include <utility>

namespace voxdag {
namespace {

constexpr int kFirstSlotsBits = 6;

/// Returns the bytes of a table of `slots` slots, in whole pages.
std::uint64_t table_bytes(std::uint64_t slots) { return std::max(std::uint64_t{4096}, 8 * slots); }

/// Makes all pages of an array resident.
void touch(PageVector<std::uint64_t>& array) {
  constexpr std::size_t kPage = 4096 / sizeof(std::uint64_t);
  for (std::size_t i = 0; i < array.size(); i += kPage)
    *static_cast<volatile std::uint64_t*>(&array[i]) = 0;
}

}  // namespace

void SpinLock::yield() { std::this_thread::yield(); }

/// Gives a shard its first table, or one twice as large. Several threads may make a first table at
/// the same time; one of the tables is used.
void SharedNumberTable::grow(std::uint32_t shard_index) {
  Shard& shard = shards_[shard_index];
  const std::uint64_t packed = tables_[shard_index].load(std::memory_order_acquire);
  const std::uint64_t bits = packed == 0 ? kFirstSlotsBits : (packed & 63) + 1;
  PageVector<std::uint64_t> larger;
  MemoryReservation reserved;
  try {
    reserved = MemoryReservation(budget_, table_bytes(std::uint64_t{1} << bits));
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
    if (budget_ != nullptr) budget_->release(shard.tables.back().bytes());
  }
  shard.tables.push_back(std::move(larger));
  shard.growing = false;
}

void SharedNumberTable::replace(std::uint32_t shard_index, std::uint64_t size) {
  Shard& shard = shards_[shard_index];
  const MemoryReservation both(budget_, table_bytes(size));
  auto table = PageVector<std::uint64_t>::zeros(size);
  NumberSlots{table.data(), table.size()}.add_all(
      {shard.tables.back().data(), shard.tables.back().size()});
  tables_[shard_index].store(reinterpret_cast<std::uint64_t>(table.data()) |
                                 static_cast<std::uint64_t>(std::countr_zero(size)),
                             std::memory_order_relaxed);
  shard.tables.clear();
  shard.tables.push_back(std::move(table));
}

std::uint64_t SharedNumberTable::count() const {
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < kShards; ++i) count += shards_[i].count;
  return count;
}

std::uint64_t SharedNumberTable::weight() const {
  std::uint64_t weight = 0;
  for (std::uint32_t i = 0; i < kShards; ++i) weight += shards_[i].weight;
  return weight;
}

void SharedNumberTable::release() {
  for (std::uint32_t i = 0; i < kShards; ++i) {
    Shard& shard = shards_[i];
    if (!shard.tables.empty() && budget_ != nullptr) budget_->release(shard.tables.back().bytes());
    shard.tables.clear();
    tables_[i].store(0, std::memory_order_relaxed);
  }
}

}  // namespace voxdag
