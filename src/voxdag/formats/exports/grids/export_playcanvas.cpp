#include "voxdag/formats/exports/grids/export_playcanvas.hpp"

#include <bit>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/full_nodes.hpp"
#include "voxdag/formats/exports/json_of.hpp"

namespace voxdag {
namespace {

/// A node is a word: its child mask in the upper 8 bits, and in the lower 24 where its children
/// begin, which follow each other in the order of the child index. A full node has the mask 0xFF
/// and no children. A leaf block of 4³ has no mask, and its index in the lower bits.
constexpr std::uint32_t kFull = 0xFF000000;
constexpr std::uint64_t kMaxIndices = std::uint64_t{1} << 24;

/// Returns the mask of a leaf block with x changing fastest, then y, then z.
std::uint64_t row_major(std::uint64_t morton_block) {
  std::uint64_t result = 0;
  for (; morton_block != 0; morton_block &= morton_block - 1) {
    const Vec3i p = morton_decode(static_cast<std::uint64_t>(std::countr_zero(morton_block)));
    result |= std::uint64_t{1} << (p.x + 4 * p.y + 16 * p.z);
  }
  return result;
}

/// Finds the words of the nodes of a DAG.
class NodeWords {
 public:
  NodeWords(const std::filesystem::path& path, const SvdagView& dag)
      : dag_(dag), full_(dag), begins_(dag.node_words()) {
    if (dag.leaf_block_count > kMaxIndices)
      refuse_export(path, std::to_string(dag.leaf_block_count) +
                              " different leaf blocks are more than the 16777216 of this format");
    for (int level = 0; level <= dag.levels - 3; ++level)
      for_each_node(dag, level, [&](std::uint64_t at) {
        if (full_.is_full(level, static_cast<std::uint32_t>(at))) return;
        begins_[at] = static_cast<std::uint32_t>(count_);
        count_ += static_cast<std::uint64_t>(popcount8(child_mask(dag.nodes + at)));
        ++inner_;
      });
    if (count_ > kMaxIndices)
      refuse_export(path,
                    std::to_string(count_) + " nodes are more than the 16777216 of this format");
  }

  std::uint64_t count() const { return dag_.is_empty() ? 0 : count_; }
  std::uint64_t inner() const { return inner_; }

  /// Calls write(word) for all words in their order.
  template <class Write>
  void for_each(const Write& write) const {
    if (dag_.is_empty()) return;
    write(word(0, 0));
    for (int level = 0; level <= dag_.levels - 3; ++level)
      for_each_node(dag_, level, [&](std::uint64_t at) {
        const std::uint32_t* const node = dag_.nodes + at;
        if (full_.is_full(level, static_cast<std::uint32_t>(at))) return;
        const int children = popcount8(child_mask(node));
        for (int i = 1; i <= children; ++i) write(word(level + 1, node[i]));
      });
  }

 private:
  std::uint32_t word(int level, std::uint32_t pointer) const {
    if (full_.is_full(level, pointer)) return kFull;
    if (level == dag_.levels - 2) return pointer;
    return child_mask(dag_.nodes + pointer) << 24 | begins_[pointer];
  }

  SvdagView dag_;
  FullNodes full_;
  std::vector<std::uint32_t> begins_;  ///< For the first word of a node: where its children begin.
  std::uint64_t count_ = 1, inner_ = 0;
};

std::string metadata(const SvdagView& dag, const Grid& grid, const NodeWords& nodes) {
  const Box3d bounds = grid.bounds();
  const nlohmann::ordered_json box = {{"min", json_of(bounds.lo)}, {"max", json_of(bounds.hi)}};
  nlohmann::ordered_json json;
  json["version"] = "1.1";
  json["asset"] = {{"generator", "voxdag"}};
  json["gridBounds"] = box;
  json["sceneBounds"] = box;
  json["voxelResolution"] = grid.voxel_size;
  json["leafSize"] = 4;
  json["treeDepth"] = dag.levels - 2;
  json["numInteriorNodes"] = nodes.inner();
  json["numMixedLeaves"] = dag.leaf_block_count;
  json["nodeCount"] = nodes.count();
  json["leafDataCount"] = 2 * dag.leaf_block_count;
  return json.dump(2) + "\n";
}

}  // namespace

void export_playcanvas(const std::filesystem::path& path, const SvdagView& dag, const Grid& grid,
                       const ExportOptions& options) {
  constexpr std::string_view kEnding = ".voxel.json";
  const std::string name = path.string();
  if (!name.ends_with(kEnding))
    throw Error(name, "", "does not end in .voxel.json, as the viewer needs");
  const NodeWords nodes(path, dag);
  const std::filesystem::path data = name.substr(0, name.size() - kEnding.size()) + ".voxel.bin";
  check_disk_space(data, nodes.count() * 4 + dag.leaf_block_count * 8);
  AtomicFile data_file(data), json_file(path);
  std::uint64_t done = 0;
  const auto report = [&] {
    if (done++ % 65536 == 0) report_export(options, done, nodes.count() + dag.leaf_block_count);
  };
  nodes.for_each([&](std::uint32_t word) {
    report();
    data_file.write(&word, sizeof word);
  });
  for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i) {
    report();
    const std::uint64_t mask = row_major(dag.leaf_blocks[i]);
    data_file.write(&mask, sizeof mask);
  }
  json_file.write(metadata(dag, grid, nodes));
  data_file.commit();
  json_file.commit();
}

}  // namespace voxdag
