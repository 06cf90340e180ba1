#pragma once
/// A size as the sum of the sizes of parts.
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace voxdag::lab {

struct SizePart {
  std::string name;
  std::uint64_t bytes = 0;

  friend bool operator==(const SizePart&, const SizePart&) = default;
};

struct SizeInParts {
  std::vector<SizePart> parts;

  std::uint64_t bytes() const {
    return std::accumulate(
        parts.begin(), parts.end(), std::uint64_t{0},
        [](std::uint64_t sum, const SizePart& part) { return sum + part.bytes; });
  }
};

}  // namespace voxdag::lab
