/// Fuzzes the .vdag reader: any bytes give an Error, or a DAG that is safe for every walk. A DAG
/// that is also canonical and minimal must equal the DAG that the reference builder makes from its
/// voxels.
///
/// The mutator keeps the offsets and checksums of the container correct (chunk_mutator.hpp). It
/// needs no corpus, because it starts with small DAGs of random voxels.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "chunk_mutator.hpp"
#include "support/brute_svdag.hpp"
#include "support/long_form.hpp"
#include "support/number_colors.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kMaxVoxels = 500;  ///< A small file can hold 2^60.

struct TooMany {};

std::vector<Vec3i> first_voxels(const SvdagView& view) {
  std::vector<Vec3i> voxels;
  try {
    for_each_voxel(view, whole_grid(view.levels), [&](Vec3i voxel) {
      if (!svdag_contains(view, voxel, view.levels)) std::abort();
      voxels.push_back(voxel);
      if (voxels.size() > kMaxVoxels) throw TooMany();
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

/// Reads the attributes of the voxels and of the cells above them.
void read_attributes(const VdagContents& contents, const std::vector<Vec3i>& voxels) {
  const ColoredDagView colored{contents.view, contents.attributes};
  if (colored.is_empty()) return;
  for (const Vec3i voxel : voxels)
    for (int shift = 0; shift <= contents.view.levels; ++shift) {
      const Vec3i cell{voxel.x >> shift, voxel.y >> shift, voxel.z >> shift};
      const StoredLook look = look_at(colored, cell, contents.view.levels - shift);
      const MaterialIdsView& materials = contents.attributes.materials;
      if (!materials.is_empty() &&
          material_at(colored, cell, contents.view.levels - shift) >= materials.materials)
        std::abort();
      if (!look.has_color && !look.has_normal && materials.is_empty()) std::abort();
    }
}

void walk(const VdagContents& contents) {
  const SvdagView& view = contents.view;
  const SvdagCounts counts = count_svdag(view);
  const std::vector<Vec3i> voxels = first_voxels(view);
  cast_rays(view, contents.metadata.grid, voxels);
  read_attributes(contents, voxels);
  const bool canonical = passes(view, check_canonical), minimal = passes(view, check_minimal);
  if (!canonical || !minimal || voxels.size() > kMaxVoxels) return;
  const Svdag reference = brute_svdag(view.levels, voxels);
  if (counts.voxels != voxels.size() || reference.nodes.size() != view.node_words() ||
      reference.leaf_blocks.size() != view.leaf_block_count ||
      !std::equal(reference.nodes.begin(), reference.nodes.end(), view.nodes) ||
      !std::equal(reference.leaf_blocks.begin(), reference.leaf_blocks.end(), view.leaf_blocks))
    std::abort();
}

void change(std::vector<Piece>& pieces, std::mt19937& rng) {
  Piece& piece = pieces[rng() % pieces.size()];
  const bool wide = piece.entry.id == kChunkLeafBlocks || piece.entry.id == kChunkLevels;
  switch (rng() % 8) {
    case 0:
      return change_bytes(piece.bytes);
    case 1:
      return change_entry(piece.entry, rng);
    default:
      return wide ? change_word<std::uint64_t>(piece.bytes, rng)
                  : change_word<std::uint32_t>(piece.bytes, rng);
  }
}

std::string seed_file(std::mt19937& rng) {
  const int levels = 2 + static_cast<int>(rng() % 7);
  const Svdag dag = brute_svdag(
      levels, random_voxels(levels, static_cast<int>(rng() % 20), static_cast<unsigned>(rng())));
  if (rng() % 4 == 0) return long_vdag_bytes(dag);
  if (rng() % 2 == 0) return vdag_file_bytes(dag);
  const int finest = static_cast<int>(rng() % static_cast<unsigned>(levels + 1));
  const NumberColors colors(dag.view(), finest);
  return vdag_file_bytes(dag, colors.view().attributes);
}

LongSvdagView parse_long(std::span<const std::byte> bytes) {
  const std::vector<VdagChunk> chunks = read_vdag_chunks(bytes);
  check_vdag_checksums(chunks);
  const LongSvdagView view = read_vdag_long_svdag(chunks, read_vdag_metadata(chunks).grid.levels);
  check_vdag_svdag(view, validate_svdag);
  return view;
}

/// Checks that a valid DAG with long pointers has as many voxels as the plain DAG that crop()
/// makes.
void walk_long(const LongSvdagView& view) {
  const std::int32_t side = std::int32_t{1} << view.levels;
  const Svdag plain = crop(view, {{0, 0, 0}, {side, side, side}});
  if (count_svdag(view).voxels != count_svdag(plain.view()).voxels) std::abort();
}

}  // namespace
}  // namespace voxdag

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  voxdag::read_and_walk(data, size, voxdag::parse_long, voxdag::walk_long);
  return voxdag::read_and_walk(data, size, voxdag::parse_vdag, voxdag::walk);
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return voxdag::mutate_chunks(data, size, max_size, seed, voxdag::change, voxdag::seed_file);
}
