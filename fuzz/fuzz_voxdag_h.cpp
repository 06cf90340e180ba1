/// Fuzzes include/voxdag.h: any bytes are refused or safe to read, and it refuses and reads what
/// the library does (tests/reader/header_scene.hpp says where both may differ).
///
/// The mutator keeps the offsets and checksums of the container correct (chunk_mutator.hpp). It
/// needs no corpus, because it starts with small DAGs of random voxels, most with attributes.
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#define VOXDAG_IMPLEMENTATION
#include "chunk_mutator.hpp"
#include "reader/header_scene.hpp"
#include "support/brute_svdag.hpp"
#include "support/number_colors.hpp"
#include "support/random_pages.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kMaxVoxels = 200;  ///< A small file can hold 2^60.

void change(std::vector<Piece>& pieces, std::mt19937& rng) {
  Piece& piece = pieces[rng() % pieces.size()];
  switch (rng() % 8) {
    case 0:
      return change_bytes(piece.bytes);
    case 1:
      return change_entry(piece.entry, rng);
    case 2:
      return change_word<std::uint8_t>(piece.bytes, rng);
    case 3:
    case 4:
      return change_word<std::uint64_t>(piece.bytes, rng);
    default:
      return change_word<std::uint32_t>(piece.bytes, rng);
  }
}

std::string seed_file(std::mt19937& rng) {
  const int levels = 2 + static_cast<int>(rng() % 6);
  const Svdag dag = brute_svdag(
      levels, random_voxels(levels, static_cast<int>(rng() % 30), static_cast<unsigned>(rng())));
  if (rng() % 4 == 0) return vdag_file_bytes(dag);
  const int finest = static_cast<int>(rng() % static_cast<unsigned>(levels + 1));
  const NumberColors numbers(dag.view(), finest);
  DagAttributesView attributes = numbers.view().attributes;
  const ValuePages colors = random_pages(attributes.index.cells, static_cast<int>(rng() % 8),
                                         static_cast<unsigned>(rng()), 0.3);
  attributes.colors = colors.view();
  return vdag_file_bytes(dag, attributes);
}

}  // namespace
}  // namespace voxdag

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string difference = voxdag::disagreement(
      std::string(reinterpret_cast<const char*>(data), size), voxdag::kMaxVoxels);
  if (difference.empty()) return 0;
  std::fprintf(stderr, "%s\n", difference.c_str());
  std::abort();
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return voxdag::mutate_chunks(data, size, max_size, seed, voxdag::change, voxdag::seed_file);
}
