#pragma once
/// Gives numbers to distinct names.
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Numbers names in the order in which they are first added. Counts its memory.
class NameTable {
 public:
  /// A null budget counts nothing.
  explicit NameTable(MemoryBudget* memory) : ids_(memory), names_(memory), long_names_(memory, 0) {}

  /// Returns the number of a name; adds the name if it is new. Throws OverMemory.
  std::uint32_t find_or_add(std::string_view name) {
    if (const auto known = find(name)) return *known;
    if (name.size() > kInlineBytes) long_names_.resize(long_names_.bytes() + name.size() + 1);
    const auto id = static_cast<std::uint32_t>(names_.size());
    names_.push_back(&ids_.emplace(name, id).first->first);
    return id;
  }
  std::optional<std::uint32_t> find(std::string_view name) const {
    const auto found = ids_.find(name);
    return found == ids_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::string& operator[](std::size_t id) const { return *names_[id]; }
  std::size_t size() const { return names_.size(); }
  bool empty() const { return names_.empty(); }

 private:
  static constexpr std::size_t kInlineBytes = 15;  ///< Longer strings allocate memory.
  using Entry = std::pair<const std::string, std::uint32_t>;

  std::map<std::string, std::uint32_t, std::less<>, CountedAllocator<Entry>> ids_;
  CountedVector<const std::string*> names_;  ///< Keys of `ids_`.
  MemoryReservation long_names_;
};

}  // namespace voxdag
