#pragma once
/// The overlays of values that edits write (stored/attributes/value_overlay.hpp). They lie in one
/// array that grows at its end; collect() frees what no root reaches.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/edit/edit_nodes.hpp"
#include "voxdag/stored/attributes/value_overlay.hpp"

namespace voxdag {

class EditValues {
 public:
  /// Counts memory in `work`.
  explicit EditValues(Work work);

  /// Returns the reference to child `index` of a reference.
  std::uint32_t child(std::uint32_t reference, int index) const {
    if (reference == kStoredValue || reference >= kOverlayValue) return reference;
    return words_.data()[std::uint64_t{8} * reference + static_cast<std::uint32_t>(index)];
  }
  /// Returns a reference to eight references: one of them if all are the same value or stored.
  /// Throws OverMemory, and Error if there are too many.
  std::uint32_t add(const std::uint32_t (&children)[8]);
  ValueOverlayView view(std::uint32_t root) const { return {words_.data(), root}; }

  std::uint64_t bytes() const { return bytes_of(end_ - 1); }
  /// One more than the last word that was ever written.
  std::uint64_t words_end() const { return std::uint64_t{8} * end_; }
  std::uint64_t unused_bytes() const { return 32 * free_.size(); }
  /// Frees the places of all words that none of these roots reaches.
  void collect(std::span<const std::uint32_t> roots);
  /// Makes this object note what is written from now on.
  void track_changes() { tracks_changes_ = true; }
  /// Returns the words that were written since the last call; none without track_changes().
  std::vector<EditRun> take_changes() { return std::exchange(changes_, {}); }

 private:
  static std::uint64_t bytes_of(std::uint64_t references) { return 32 * references; }
  void mark(std::uint32_t reference);

  PageVector<std::uint32_t> words_;
  MemoryReservation memory_;
  std::uint32_t end_ = 1;  ///< One more than the last reference in use.
  std::vector<std::uint32_t> free_;
  std::vector<bool> marks_;
  std::vector<EditRun> changes_;
  bool tracks_changes_ = false;
};

}  // namespace voxdag
