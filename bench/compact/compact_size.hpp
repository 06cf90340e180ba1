#pragma once
/// The size of a DAG in a compact form.
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace voxdag {

struct SizePart {
  std::string name;
  std::uint64_t bytes = 0;

  friend bool operator==(const SizePart&, const SizePart&) = default;
};

struct CompactSize {
  std::vector<SizePart> parts;

  std::uint64_t bytes() const {
    return std::accumulate(
        parts.begin(), parts.end(), std::uint64_t{0},
        [](std::uint64_t sum, const SizePart& part) { return sum + part.bytes; });
  }
};

}  // namespace voxdag
