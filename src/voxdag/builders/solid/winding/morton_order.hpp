#pragma once
/// Sorts parts of a surface, so that near ones are near each other in memory.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "voxdag/core/morton.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"

namespace voxdag {

/// Fills `sorted` with the items in the Morton order of place_of(item). Throws OverMemory and
/// Cancelled.
template <class Items, class Item, class PlaceOf>
void sort_by_place(const Items& items, PageVector<Item>& sorted, Work work,
                   const PlaceOf& place_of) {
  struct Key {
    std::uint64_t code;
    std::size_t item;
    bool operator<(const Key& other) const {
      return code != other.code ? code < other.code : item < other.item;
    }
  };
  Vec3d lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi = -lo;
  for (const Item& item : items) {
    lo = min(lo, place_of(item));
    hi = max(hi, place_of(item));
  }
  const Vec3d extent = hi - lo;
  const double scale = ((1 << 21) - 1) / std::max({extent.x, extent.y, extent.z, 1.0});
  PageVector<Key> keys(work.memory);
  keys.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    work.poll_seldom(i);
    keys[i] = {morton_encode(static_cast<Vec3i>((place_of(items[i]) - lo) * scale)), i};
  }
  polled_sort(keys.begin(), keys.end(), work);
  sorted.resize(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) sorted[i] = items[keys[i].item];
}

}  // namespace voxdag
