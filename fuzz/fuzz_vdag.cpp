// The .vdag reader: any bytes give an Error or a DAG that every walk survives; one that is also
// canonical and minimal must be the one that the reference builder makes of its voxels.
//
// The mutator knows the container: it changes chunks and puts them together with the right offsets
// and checksums, so that mutations reach what is behind them. It needs no corpus: from nothing it
// starts with small DAGs of random voxels.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "support/brute_svdag.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/layout/for_each_voxel.hpp"
#include "voxdag/layout/svdag_lookup.hpp"
#include "voxdag/layout/validate_svdag.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace voxdag {
namespace {

constexpr std::size_t kMostVoxels = 500;  ///< A small file can hold 2^60.

struct TooMany {};

std::vector<Vec3i> first_voxels(const SvdagView& view) {
  std::vector<Vec3i> voxels;
  try {
    for_each_voxel(view, whole_grid(view.levels), [&](Vec3i voxel) {
      if (!svdag_contains(view, voxel, view.levels)) std::abort();
      voxels.push_back(voxel);
      if (voxels.size() > kMostVoxels) throw TooMany();
    });
  } catch (const TooMany&) {
  }
  return voxels;
}

void cast_rays(const SvdagView& view, const Grid& grid, const std::vector<Vec3i>& voxels) {
  const SvdagNodes nodes(view);
  const auto check = [&](const Ray& ray) {
    const Hit hit = closest_hit(nodes, grid, ray);
    if (hit.hit && !svdag_contains(view, hit.voxel, view.levels)) std::abort();
  };
  const Vec3d center = grid.to_world(Vec3d{0.5, 0.5, 0.5} * static_cast<double>(grid.resolution()));
  for (std::size_t i = 0; i < voxels.size(); i += 50) {
    const Vec3d target = grid.to_world(Vec3d(voxels[i]) + Vec3d{0.5, 0.5, 0.5});
    check({Vec3f(grid.origin), 0, Vec3f(target - grid.origin), HUGE_VALF});
    check({Vec3f(target), 0, Vec3f(target - center), HUGE_VALF});
    check({Vec3f(target), -HUGE_VALF, {1, 0, 0}, HUGE_VALF});
  }
}

bool passes(const SvdagView& view, void (*check)(const SvdagView&)) {
  try {
    check_vdag_svdag(view, check);
    return true;
  } catch (const Error&) {
    return false;
  }
}

void walk(const VdagContents& contents) {
  const SvdagView& view = contents.view;
  const SvdagCounts counts = count_svdag(view);
  const std::vector<Vec3i> voxels = first_voxels(view);
  cast_rays(view, contents.metadata.grid, voxels);
  const bool canonical = passes(view, check_canonical), minimal = passes(view, check_minimal);
  if (!canonical || !minimal || voxels.size() > kMostVoxels) return;
  const Svdag reference = brute_svdag(view.levels, voxels);
  if (counts.voxels != voxels.size() || reference.nodes.size() != view.node_words() ||
      reference.leaf_blocks.size() != view.leaf_block_count ||
      !std::equal(reference.nodes.begin(), reference.nodes.end(), view.nodes) ||
      !std::equal(reference.leaf_blocks.begin(), reference.leaf_blocks.end(), view.leaf_blocks))
    std::abort();
}

struct Piece {
  VdagChunkEntry entry;
  std::string bytes;
};

std::vector<Piece> take_apart(const std::string& file) {
  std::vector<Piece> pieces;
  if (file.size() < sizeof(VdagHeader)) return pieces;
  const auto count = peek<VdagHeader>(file, 0).chunk_count;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 8); ++i) {
    if (entry_offset(i + 1) > file.size()) break;
    const auto entry = peek<VdagChunkEntry>(file, entry_offset(i));
    if (entry.offset > file.size() || entry.length > file.size() - entry.offset) break;
    pieces.push_back({entry, file.substr(entry.offset, entry.length)});
  }
  return pieces;
}

std::string put_together(const std::vector<Piece>& pieces) {
  std::string file(vdag_align(entry_offset(pieces.size())), '\0');
  VdagHeader header{};
  std::memcpy(header.magic, kVdagMagic, sizeof kVdagMagic);
  header.version = kVdagVersion;
  header.chunk_count = static_cast<std::uint32_t>(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    VdagChunkEntry entry = pieces[i].entry;
    entry.offset = file.size();
    entry.length = pieces[i].bytes.size();
    poke(file, entry_offset(i), entry);
    file += pieces[i].bytes;
    file.resize(vdag_align(file.size()));
  }
  header.file_bytes = file.size();
  poke(file, 0, header);
  repair_checksums(file);
  return file;
}

/// Changes one word a little, or copies one word over another: what is likely to stay a DAG.
template <class T>
void change_word(std::string& bytes, std::mt19937& rng) {
  const std::size_t count = bytes.size() / sizeof(T);
  if (count == 0) return;
  const auto offset = [&] { return rng() % count * sizeof(T); };
  const std::size_t to = offset();
  T value = peek<T>(bytes, offset());
  if (rng() % 2 == 0) value = static_cast<T>(peek<T>(bytes, to) + static_cast<T>(rng() % 9) - 4);
  if (rng() % 4 == 0) value ^= T{1} << rng() % (8 * sizeof(T));
  poke(bytes, to, value);
}

void change_bytes(std::string& bytes) {
  const std::size_t size = bytes.size(), most = size + 64;
  bytes.resize(most);
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, most));
}

void change(std::vector<Piece>& pieces, std::mt19937& rng) {
  Piece& piece = pieces[rng() % pieces.size()];
  const bool wide = piece.entry.id == kChunkLeafBlocks || piece.entry.id == kChunkLevels;
  switch (rng() % 8) {
    case 0:
      return change_bytes(piece.bytes);
    case 1: {
      std::string entry(sizeof piece.entry, '\0');
      poke(entry, 0, piece.entry);
      entry[rng() % 8] ^= static_cast<char>(1 << rng() % 8);
      piece.entry = peek<VdagChunkEntry>(entry, 0);
      return;
    }
    default:
      return wide ? change_word<std::uint64_t>(piece.bytes, rng)
                  : change_word<std::uint32_t>(piece.bytes, rng);
  }
}

std::string seed_file(std::mt19937& rng) {
  const int levels = 2 + static_cast<int>(rng() % 7);
  return vdag_file_bytes(brute_svdag(
      levels, random_voxels(levels, static_cast<int>(rng() % 20), static_cast<unsigned>(rng()))));
}

}  // namespace
}  // namespace voxdag

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace voxdag;
  const AlignedBytes bytes(std::string(reinterpret_cast<const char*>(data), size));
  try {
    walk(parse_vdag(bytes.span()));
  } catch (const Error&) {
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using namespace voxdag;
  std::mt19937 rng(seed);
  if (rng() % 32 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::string old(reinterpret_cast<const char*>(data), size);
  std::vector<Piece> pieces = take_apart(old);
  std::string file;
  if (pieces.empty() || rng() % 256 == 0) {
    file = seed_file(rng);
  } else {
    for (unsigned i = 0; i <= rng() % 4; ++i) change(pieces, rng);
    file = put_together(pieces);
  }
  if (file.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, file.data(), file.size());
  return file.size();
}
