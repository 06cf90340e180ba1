#include "voxdag/cluster/unique_records.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "voxdag/core/io/checksum.hpp"

namespace voxdag {
namespace {

/// Returns 24 bits that neither the slot nor the owner of a record decides.
std::uint64_t tag_of(std::uint64_t hash) { return hash >> 24 & 0xFFFFFF; }

}  // namespace

UniqueRecords::UniqueRecords(MemoryBudget* budget)
    : budget_(budget), bytes_(budget), begins_(budget), slots_(budget), log2_slots_(10) {
  begins_.push_back(0);
  slots_.resize(std::size_t{1} << log2_slots_);
}

void UniqueRecords::grow() {
  slots_.release();
  slots_ = PageVector<std::uint64_t>(budget_);
  slots_.resize(std::size_t{1} << ++log2_slots_);
  const std::uint64_t last = slots_.size() - 1;
  for (std::uint64_t number = 0; number < count(); ++number) {
    const std::uint64_t begin = begins_[number];
    const std::uint64_t hash = xxh3_64(bytes().subspan(begin, begins_[number + 1] - begin));
    std::uint64_t i = hash & last;
    while (slots_[i] != 0) i = (i + 1) & last;
    slots_[i] = tag_of(hash) << kNumberBits | (number + 1);
  }
}

std::uint64_t UniqueRecords::find_or_add(std::span<const std::byte> record, std::uint64_t hash) {
  constexpr std::uint64_t kNumbers = std::uint64_t{1} << kNumberBits;
  if (count() * 3 >= slots_.size() * 2) grow();
  const std::uint64_t last = slots_.size() - 1, tag = tag_of(hash);
  for (std::uint64_t i = hash & last;; i = (i + 1) & last) {
    const std::uint64_t slot = slots_[i];
    if (slot == 0) {
      const std::uint64_t number = count();
      const std::size_t begin = bytes_.size();
      bytes_.resize(begin + record.size());
      std::memcpy(bytes_.data() + begin, record.data(), record.size());
      begins_.push_back(bytes_.size());
      slots_[i] = tag << kNumberBits | (number + 1);
      return number;
    }
    if (slot >> kNumberBits != tag) continue;
    const std::uint64_t number = slot % kNumbers - 1;
    const std::uint64_t begin = begins_[number], size = begins_[number + 1] - begin;
    if (size == record.size() && std::memcmp(bytes_.data() + begin, record.data(), size) == 0)
      return number;
  }
}

}  // namespace voxdag
