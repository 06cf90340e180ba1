#pragma once
/// DAGs with long pointers, made from plain ones.
#include <cstring>
#include <string>

#include "support/vdag_bytes.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"

namespace voxdag {

/// A DAG with long pointers in memory.
struct LongForm {
  Svdag dag;  ///< `nodes` have long pointers.

  LongSvdagView view() const {
    LongSvdagView view;
    view.nodes = dag.nodes.data();
    view.leaf_blocks = dag.leaf_blocks.data();
    view.leaf_block_count = dag.leaf_blocks.size();
    std::copy(dag.level_begin.begin(), dag.level_begin.end(), view.level_begin);
    view.levels = dag.levels;
    return view;
  }
};

/// Returns the same DAG with pointers that count from the first word of each level.
inline LongForm long_form(Svdag dag) {
  for (int level = 0; level + 1 < dag.levels - 2; ++level) {
    const auto l = static_cast<std::size_t>(level);
    for (std::uint64_t at = dag.level_begin[l]; at < dag.level_begin[l + 1];) {
      const int children = popcount(dag.nodes[at++]);
      for (int i = 0; i < children; ++i)
        dag.nodes[at++] -= static_cast<std::uint32_t>(dag.level_begin[l + 1]);
    }
  }
  return {std::move(dag)};
}

/// Returns the bytes of a .vdag file with the chunk NODX.
inline std::string long_vdag_bytes(const Svdag& dag) {
  constexpr std::size_t kNodeChunk = 2;
  std::string bytes = vdag_file_bytes(dag);
  const auto entry = peek<VdagChunkEntry>(bytes, entry_offset(kNodeChunk));
  poke(bytes, entry_offset(kNodeChunk), kChunkLongNodes);
  const LongForm form = long_form(dag);
  std::memcpy(bytes.data() + entry.offset, form.dag.nodes.data(), entry.length);
  repair_checksums(bytes);
  return bytes;
}

}  // namespace voxdag
