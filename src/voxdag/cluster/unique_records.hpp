#pragma once
/// A table of different records: gives equal records equal numbers.
#include <cstdint>
#include <cstring>
#include <span>

#include "voxdag/core/error.hpp"
#include "voxdag/core/number_table.hpp"
#include "voxdag/core/page_vector.hpp"

namespace voxdag {

/// Numbers records from 0 in the order in which they are first added.
class UniqueRecords {
 public:
  /// A null budget counts nothing.
  explicit UniqueRecords(MemoryBudget* budget) : bytes_(budget), begins_(budget), table_(budget) {
    begins_.push_back(0);
  }

  /// Returns the number of the record; `hash` is its xxh3_64(). Throws OverMemory, and Error if
  /// there are 2^32 - 1 records.
  std::uint64_t find_or_add(std::span<const std::byte> record, std::uint64_t hash) {
    return table_.find_or_add(
        hash,
        [&](std::uint32_t number) {
          const std::uint64_t begin = begins_[number], size = begins_[number + 1] - begin;
          return size == record.size() &&
                 std::memcmp(bytes_.data() + begin, record.data(), size) == 0;
        },
        [&] {
          const std::uint64_t number = count(), begin = bytes_.size();
          if (number == NumberSlots::kMaxNumbers)
            throw Error("too many records: one table has at most 2^32 - 1");
          bytes_.resize(begin + record.size());
          std::memcpy(bytes_.data() + begin, record.data(), record.size());
          begins_.push_back(bytes_.size());
          return static_cast<std::uint32_t>(number);
        });
  }

  std::uint64_t count() const { return begins_.size() - 1; }
  /// Returns the bytes of all records, in the order of their numbers.
  std::span<const std::byte> bytes() const { return {bytes_.data(), bytes_.size()}; }

 private:
  PageVector<std::byte> bytes_;
  PageVector<std::uint64_t> begins_;  ///< Where each record begins; then the size of all.
  NumberTable table_;
};

}  // namespace voxdag
