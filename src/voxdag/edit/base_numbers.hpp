#pragma once
/// Finds the nodes of one level of a DAG that does not change, by their words.
#include <cstdint>

#include "voxdag/core/number_table.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the hash of a leaf block: that of its two words.
inline std::uint64_t hash_block(std::uint64_t voxels) {
  const std::uint32_t words[] = {static_cast<std::uint32_t>(voxels),
                                 static_cast<std::uint32_t>(voxels >> 32)};
  return hash_words(words, 2);
}

/// A hash table of nodes. Their numbers are word indices, or indices of leaf blocks. Thread-safe.
class BaseNumbers {
 public:
  /// Hashes the nodes of a level from 0 to L-2, on the current TBB arena. `work` counts the table
  /// as long as this object lives. Throws OverMemory, Cancelled and std::bad_alloc.
  BaseNumbers(const SvdagView& dag, int level, Work work);

  /// Returns whether no two nodes of the level are equal.
  bool is_minimal() const { return is_minimal_; }
  /// Returns whether there is a node with this hash for which is_equal(number) is true, and its
  /// number.
  template <class IsEqual>
  bool find(std::uint64_t hash, const IsEqual& is_equal, std::uint32_t& number) const {
    std::uint64_t slot = 0;
    table().find(NumberSlots::tag_of(hash), is_equal, slot);
    if (slot != 0) number = NumberSlots::number_of(slot);
    return slot != 0;
  }
  /// Starts loading the slot that find() reads first.
  void prefetch(std::uint64_t hash) const {
    __builtin_prefetch(slots_.data() + table().first_of(NumberSlots::tag_of(hash)));
  }

 private:
  /// Nothing writes to the slots after the constructor.
  NumberSlots table() const { return {const_cast<std::uint64_t*>(slots_.data()), slots_.size()}; }

  bool is_minimal_ = true;
  MemoryReservation memory_;
  PageVector<std::uint64_t> slots_;
};

}  // namespace voxdag
