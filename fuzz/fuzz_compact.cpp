/// Fuzzes the reader of compact DAGs: any bytes give an Error, or a DAG that is safe to read. What
/// decodes is a valid DAG in canonical order.
///
/// The mutator keeps the offsets and checksums of the container correct (chunk_mutator.hpp). It
/// needs no corpus, because it starts with small DAGs of random voxels.
#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "chunk_mutator.hpp"
#include "support/brute_svdag.hpp"
#include "support/compact_walk.hpp"
#include "support/number_colors.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag {
namespace {

/// Reads the attributes of some cells of all levels.
void read_attributes(const CompactContents& contents, const SvdagView& dag) {
  if (!contents.has_attributes()) return;
  const CellIndex index = build_cell_index(dag, contents.metadata.attributes.level());
  ExpandedChunks expanded;
  DagAttributesView attributes;
  try {
    attributes = contents.attributes(index.view(), expanded);
  } catch (const Error&) {
    return;
  }
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(index.cells, 5000); ++i) {
    if (attributes.has_colors()) read_value(attributes.colors, i);
    if (attributes.has_normals()) read_value(attributes.normals, index.cells - 1 - i);
    if (attributes.has_materials() &&
        read_material(attributes.materials, index.cells - 1 - i) >= attributes.materials.materials)
      std::abort();
  }
}

void walk(const CompactContents& contents) {
  const CompactSvdagView view = contents.view();
  if (!ranges_are_safe(view, 1000)) std::abort();
  Svdag dag;
  try {
    MemoryBudget memory(std::uint64_t{256} << 20);
    dag = decode_svdag(view, &memory);
  } catch (const Error&) {
    return;
  }
  validate_svdag(dag.view());
  if (dag.nodes.size() > 100'000) return;
  read_attributes(contents, dag.view());
  check_canonical(dag.view());
}

void change(std::vector<Piece>& pieces, std::mt19937& rng) {
  Piece& piece = pieces[rng() % pieces.size()];
  switch (rng() % 8) {
    case 0:
      return change_bytes(piece.bytes);
    case 1:
      return change_entry(piece.entry, rng);
    default:
      return change_word<std::uint32_t>(piece.bytes, rng);
  }
}

std::string seed_file(std::mt19937& rng) {
  const int levels = 2 + static_cast<int>(rng() % 7);
  const Svdag dag = brute_svdag(
      levels, random_voxels(levels, static_cast<int>(rng() % 200), static_cast<unsigned>(rng())));
  const TempDir dir;
  VdagMetadata metadata = example_metadata(dag.view());
  const int finest = static_cast<int>(rng() % static_cast<unsigned>(levels + 1));
  const NumberColors colors(dag.view(), finest);
  DagAttributesView attributes;
  if (rng() % 2 == 0 && !dag.view().is_empty()) {
    attributes = colors.view().attributes;
    metadata.attributes.resolution = std::int64_t{1} << finest;
    metadata.attributes.colors = metadata.attributes.normals = {0.5, 3};
    metadata.attributes.materials.emplace(kNumberMaterials, "name");
  }
  const AttributeForm form = rng() % 2 == 0 ? AttributeForm::kPages : AttributeForm::kWire;
  write_vdag(dir / "file.vdag", encode_svdag(dag.view()), metadata, attributes, form);
  return read_text(dir / "file.vdag");
}

}  // namespace
}  // namespace voxdag

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return voxdag::read_and_walk(data, size, voxdag::parse_compact, voxdag::walk);
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return voxdag::mutate_chunks(data, size, max_size, seed, voxdag::change, voxdag::seed_file);
}
