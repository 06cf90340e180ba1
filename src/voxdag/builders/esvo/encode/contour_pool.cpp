#include "voxdag/builders/esvo/encode/contour_pool.hpp"

#include <algorithm>

namespace voxdag {
namespace {

/// Returns the hash of a run from the hash of the run without its last contour.
std::uint64_t hash_next(std::uint64_t hash, Contour contour) {
  hash = (hash ^ contour.bits) * 0x9E3779B97F4A7C15u;
  return hash ^ hash >> 32;
}

}  // namespace

std::uint32_t ContourPool::add(std::span<const Contour> list) {
  std::uint64_t whole = list.size();
  for (const Contour contour : list) whole = hash_next(whole, contour);
  if (const auto found = places_.find(whole); found != places_.end()) {
    const std::size_t place = found->second;
    // If the hashes of different lists collide, the later list is not shared.
    if (place + list.size() <= contours_.size() &&
        std::equal(list.begin(), list.end(), contours_.begin() + found->second))
      return found->second;
  }
  const auto place = static_cast<std::uint32_t>(contours_.size());
  contours_.insert(contours_.end(), list.begin(), list.end());
  for (std::size_t first = 0; first < list.size(); ++first)
    for (std::size_t count = 1; first + count <= list.size(); ++count) {
      std::uint64_t hash = count;
      for (const Contour contour : list.subspan(first, count)) hash = hash_next(hash, contour);
      places_.emplace(hash, place + static_cast<std::uint32_t>(first));
    }
  return place;
}

}  // namespace voxdag
