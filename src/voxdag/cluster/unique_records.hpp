#pragma once
/// A table of different records: gives equal records equal numbers.
#include <cstdint>
#include <span>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/page_vector.hpp"

namespace voxdag {

/// Numbers records from 0 in the order in which they are first added.
class UniqueRecords {
 public:
  /// A null budget counts nothing.
  explicit UniqueRecords(MemoryBudget* budget);

  /// Returns the number of the record; `hash` is its xxh3_64(). Throws OverMemory.
  std::uint64_t find_or_add(std::span<const std::byte> record, std::uint64_t hash);

  std::uint64_t count() const { return begins_.size() - 1; }
  /// Returns the bytes of all records, in the order of their numbers.
  std::span<const std::byte> bytes() const { return {bytes_.data(), bytes_.size()}; }

 private:
  // A slot holds 24 bits of the hash and the record's number plus one; 0: free. Linear probing.
  static constexpr int kNumberBits = 40;

  void grow();

  MemoryBudget* budget_;
  PageVector<std::byte> bytes_;
  PageVector<std::uint64_t> begins_;  ///< Where each record begins; then the size of all.
  PageVector<std::uint64_t> slots_;
  int log2_slots_ = 0;
};

}  // namespace voxdag
