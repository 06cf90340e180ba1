#include "voxdag/edit/edit_values.hpp"

#include <algorithm>
#include <utility>

#include "voxdag/core/checked_size.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/pages.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kMaxReferences = 1u << 28;

}  // namespace

EditValues::EditValues(Work work)
    : words_(PageVector<std::uint32_t>::zeros(
          checked_size(bytes_to_map(0, std::uint64_t{32} * kMaxReferences) / 4))),
      memory_(work.memory, kHugePage) {}

std::uint32_t EditValues::add(const std::uint32_t (&children)[8]) {
  const bool is_same = std::all_of(children, children + 8,
                                   [&](std::uint32_t child) { return child == children[0]; });
  if (is_same && (children[0] == kStoredValue || children[0] >= kOverlayValue)) return children[0];
  std::uint32_t at = end_;
  if (!free_.empty()) {
    at = free_.back();
    free_.pop_back();
  } else {
    if (8 * (std::uint64_t{end_} + 1) > words_.size())
      throw Error("the edits have too many different values");
    const std::uint64_t bytes = (bytes_of(end_ + 1) + kHugePage - 1) / kHugePage * kHugePage;
    if (bytes > memory_.bytes()) memory_.resize(bytes);
    ++end_;
  }
  std::copy_n(children, 8, words_.data() + std::uint64_t{8} * at);
  if (tracks_changes_) note_run(changes_, std::uint64_t{8} * at, 8);
  return at;
}

void EditValues::mark(std::uint32_t reference) {
  if (reference == kStoredValue || reference >= kOverlayValue || marks_[reference]) return;
  marks_[reference] = true;
  for (int i = 0; i < 8; ++i) mark(child(reference, i));
}

void EditValues::collect(std::span<const std::uint32_t> roots) {
  marks_.assign(end_, false);
  for (const std::uint32_t root : roots) mark(root);
  free_.clear();
  for (std::uint32_t at = 1; at < end_; ++at)
    if (!marks_[at]) free_.push_back(at);
  marks_ = {};
}

}  // namespace voxdag
