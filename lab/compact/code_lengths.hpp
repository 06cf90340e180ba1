#pragma once
/// Lengths of an optimal prefix code in which no code word is longer than a limit.
///
/// Lawrence Larmore and Daniel Hirschberg: A fast algorithm for optimal length-limited Huffman
/// codes, Journal of the ACM 37(3), 1990 (package-merge).
#include <cstdint>
#include <span>
#include <vector>

namespace voxdag::lab {

/// Returns a length in bits for each symbol. Symbols of frequency 0 get code words too. There are
/// at least two symbols, and at most 2^limit.
std::vector<int> code_lengths(std::span<const std::uint64_t> frequencies, int limit);

}  // namespace voxdag::lab
