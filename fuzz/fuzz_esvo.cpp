/// Fuzzes the reader of ESVO files: any bytes give an Error, or an octree that is safe for every
/// walk. Blocks of several pages need -max_len=131072.
///
/// The mutator keeps the container and the checksums of the blocks correct (chunk_mutator.hpp). It
/// needs no corpus, because it starts with small random octrees with contours.
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "chunk_mutator.hpp"
#include "support/esvo_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/esvo_parse.hpp"
#include "voxdag/stored/esvo/esvo_bytes.hpp"
#include "voxdag/stored/esvo/esvo_leaf_parts.hpp"
#include "voxdag/stored/esvo/stored_values.hpp"
#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {
namespace {

struct TooMany {};

/// Returns the origins of the first parts of leaves, and reads the leaves' attributes.
std::vector<Vec3i> first_parts(const EsvoView& view) {
  constexpr std::size_t kMax = 500;  // a small file can represent 2^60 voxels
  std::vector<Vec3i> blocks;
  try {
    for_each_leaf_part(view, whole_grid(view.levels),
                       [&](Vec3i origin, std::uint64_t mask, const EsvoVoxel& leaf) {
                         Vec3f value;
                         stored_color(view, leaf, value);
                         stored_normal(view, leaf, value);
                         if (mask == 0 || leaf.slot >= view.slot_count) std::abort();
                         blocks.push_back(origin);
                         if (blocks.size() > kMax) throw TooMany();
                       });
  } catch (const TooMany&) {
  }
  return blocks;
}

template <class Nodes>
void cast_rays(const Nodes& nodes, const Grid& grid, const std::vector<Vec3i>& targets) {
  for (std::size_t i = 0; i < targets.size(); i += 25) {
    const Vec3d target = grid.to_world(Vec3d(targets[i]) + Vec3d{2, 2, 2});
    for (const Ray& ray : {Ray{Vec3f(grid.origin), 0, Vec3f(target - grid.origin), HUGE_VALF},
                           Ray{Vec3f(target), -HUGE_VALF, {1, 0, 0}, HUGE_VALF}}) {
      const Hit hit = closest_hit(nodes, grid, ray);
      if (!hit.hit) continue;
      for (int axis = 0; axis < 3; ++axis)
        if (hit.voxel[axis] < 0 || hit.voxel[axis] >= grid.resolution()) std::abort();
    }
  }
}

void walk(const EsvoContents& contents) {
  const EsvoView& view = contents.view;
  const EsvoBytes bytes = esvo_bytes(view, contents.directory);
  if (bytes.total() != view.slot_count * 8) std::abort();
  const std::vector<Vec3i> targets = first_parts(view);
  cast_rays(EsvoNodes(view), contents.metadata.grid, targets);
  cast_rays(ContourNodes(view), contents.metadata.grid, targets);
}

/// Writes the checksums of the blocks into the directory.
void repair_blocks(std::vector<Piece>& pieces) {
  const auto find = [&](std::uint32_t id) {
    return std::find_if(pieces.begin(), pieces.end(),
                        [&](const Piece& piece) { return piece.entry.id == id; });
  };
  const auto blocks = find(kChunkEsvo), directory = find(kChunkEsvoBlocks);
  if (blocks == pieces.end() || directory == pieces.end()) return;
  for (std::size_t at = 0; at + sizeof(EsvoBlockEntry) <= directory->bytes.size();
       at += sizeof(EsvoBlockEntry)) {
    auto entry = peek<EsvoBlockEntry>(directory->bytes, at);
    const std::uint64_t begin = entry.begin * 8, size = std::uint64_t{entry.slots} * 8;
    if (begin > blocks->bytes.size() || size > blocks->bytes.size() - begin) continue;
    entry.checksum = xxh3_64(std::as_bytes(std::span(blocks->bytes).subspan(begin, size)));
    poke(directory->bytes, at, entry);
  }
}

/// Changes one of the slots that are not zero.
void change_slot(std::string& bytes, std::mt19937& rng) {
  std::vector<std::size_t> used;
  for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8)
    if (peek<std::uint64_t>(bytes, at) != 0) used.push_back(at);
  if (used.empty()) return;
  const std::size_t to = used[rng() % used.size()];
  auto value = peek<std::uint64_t>(bytes, to);
  switch (rng() % 3) {
    case 0:
      value = peek<std::uint64_t>(bytes, used[rng() % used.size()]);
      break;
    case 1:
      value += rng() % 9 - 4;
      break;
    default:
      value ^= std::uint64_t{1} << rng() % 64;
  }
  poke(bytes, to, value);
}

void change(std::vector<Piece>& pieces, std::mt19937& rng) {
  Piece& piece = pieces[rng() % pieces.size()];
  switch (rng() % 8) {
    case 0:
      change_bytes(piece.bytes);
      break;
    case 1:
      change_entry(piece.entry, rng);
      break;
    default:
      if (piece.entry.id == kChunkEsvo)
        change_slot(piece.bytes, rng);
      else
        change_word<std::uint32_t>(piece.bytes, rng);
  }
  if (rng() % 16 != 0) repair_blocks(pieces);
}

std::string seed_file(std::mt19937& rng) {
  const TempDir dir;
  test::write_esvo(dir / "a.esvo",
                   test::packed_esvo(2 + static_cast<int>(rng() % 3), 8u << rng() % 4,
                                     static_cast<std::uint32_t>(rng())));
  return read_text(dir / "a.esvo");
}

}  // namespace
}  // namespace voxdag

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return voxdag::read_and_walk(data, size, voxdag::parse_esvo, voxdag::walk);
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return voxdag::mutate_chunks(data, size, max_size, seed, voxdag::change, voxdag::seed_file);
}
