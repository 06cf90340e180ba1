#pragma once
/// Joins the voxels of another DAG with those of an edited one.
#include <unordered_map>
#include <vector>

#include "voxdag/algebra/source_dag.hpp"
#include "voxdag/edit/edit_nodes.hpp"

namespace voxdag {

/// Adds or removes the voxels of a DAG in the same grid. Equal pairs of nodes are joined once, so
/// the cost follows the different pairs.
class StampEdit {
 public:
  StampEdit(EditNodes::Writer& writer, const SvdagView& stamp, bool adds)
      : nodes_(writer.nodes()),
        writer_(writer),
        stamp_(stamp),
        adds_(adds),
        known_(static_cast<std::size_t>(nodes_.levels())) {}

  /// Returns the root after the edit. EditNodes::add_full() must have been called if it adds.
  /// Throws what EditNodes::Writer::intern() throws.
  std::uint32_t run(std::uint32_t root) { return join(0, root, stamp_.root()); }

 private:
  std::uint32_t join(int level, std::uint32_t node, std::uint32_t stamp) {
    if (stamp == kNoCell) return node;
    if (node == (adds_ ? nodes_.full(level) : EditNodes::kNone)) return node;
    if (level == nodes_.levels() - 2) {
      const std::uint64_t before = node == EditNodes::kNone ? 0 : nodes_.block(node),
                          block = stamp_.block(stamp);
      return writer_.intern_block(adds_ ? before | block : before & ~block);
    }
    const std::uint64_t key = std::uint64_t{node} << 32 | stamp;
    auto& known = known_[static_cast<std::size_t>(level)];
    if (const auto found = known.find(key); found != known.end()) return found->second;
    std::uint32_t children[8];
    for (int i = 0; i < 8; ++i)
      children[i] = join(level + 1, nodes_.child(node, i), stamp_.child(level, stamp, i));
    return known[key] = writer_.intern(level, children);
  }

  const EditNodes& nodes_;
  EditNodes::Writer& writer_;
  SourceDag stamp_;
  const bool adds_;
  std::vector<std::unordered_map<std::uint64_t, std::uint32_t>> known_;
};

}  // namespace voxdag
