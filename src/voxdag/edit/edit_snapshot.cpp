#include "voxdag/algebra/attributes/derive_attributes.hpp"
#include "voxdag/algebra/attributes/placed_channels.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/edit/editable_dag.hpp"
#include "voxdag/edit/edited_source.hpp"
#include "voxdag/stored/svdag/canonical_order.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// The nodes of a version as the `source` of canonical_order().
class VersionSource {
 public:
  VersionSource(const SvdagView& dag, std::uint64_t words_end, Work work)
      : dag_(dag),
        bytes_(work.memory, (words_end + dag.leaf_block_count) * sizeof(std::uint32_t)),
        nodes_(PageVector<std::uint32_t>::zeros(words_end)),
        blocks_(PageVector<std::uint32_t>::zeros(dag.leaf_block_count)) {}

  const std::uint32_t* words(int, std::uint32_t id) const { return dag_.nodes + id; }
  std::uint64_t leaf_block(std::uint32_t id) const { return dag_.leaf_blocks[id]; }
  std::uint32_t& forward(int level, std::uint32_t id) {
    return (level == dag_.levels - 2 ? blocks_ : nodes_)[id];
  }
  void prefetch(int level, std::uint32_t id) const {
    if (level == dag_.levels - 2) {
      __builtin_prefetch(dag_.leaf_blocks + id);
      __builtin_prefetch(blocks_.data() + id, 1);
    } else {
      __builtin_prefetch(dag_.nodes + id);
      __builtin_prefetch(nodes_.data() + id, 1);
    }
  }
  void release(int) const {}
  std::uint64_t node_words() const { return nodes_.size(); }
  std::uint64_t leaf_blocks() const { return blocks_.size(); }

 private:
  SvdagView dag_;
  MemoryReservation bytes_;
  PageVector<std::uint32_t> nodes_, blocks_;  ///< The words for forward().
};

}  // namespace

Svdag EditSnapshot::svdag(Work work) const {
  if (!version_->nodes->is_minimal()) return crop(view(), whole_grid(view().levels), work);
  Svdag empty;
  empty.levels = view().levels;
  if (view().is_empty()) return empty;
  VersionSource source(view(), version_->words_end, work);
  return canonical_order(source, view().levels, view().root, work);
}

DagAttributes EditSnapshot::attributes(const SvdagView& dag, const CoarsenBounds& bounds,
                                       Work work) const {
  const ColoredDagView& values = version_->values;
  const EditedSource source(*version_->nodes, *version_->of_values, version_->root, values.overlays,
                            values.attributes);
  const int finest = values.attributes.index.finest_level;
  DagAttributes attributes = derive_attributes(dag, finest, source, bounds, work);
  if (!values.attributes.has_channels()) return attributes;
  const AttributeLayer base{{values.dag, values.attributes}};
  add_placed_channels(attributes, dag, finest, {&base, 1}, work);
  return attributes;
}

}  // namespace voxdag
