#include "voxdag/algebra/coarsen.hpp"

#include <cassert>

#include "voxdag/algebra/long_source_dag.hpp"
#include "voxdag/algebra/source_dag.hpp"

namespace voxdag {
namespace {

/// A key is a node. Cells of the coarser grid's level L-2 become leaf blocks.
template <class Source>
class CoarsenRule {
 public:
  using Key = typename Source::Key;
  static constexpr std::size_t kWords = std::tuple_size_v<Key>;

  CoarsenRule(const Source& source, int levels) : source_(source), levels_(levels) {}

  Key root() const { return source_.root_key(); }
  void children(int level, const Key& key, Key (&keys)[8]) const {
    for (int i = 0; i < 8; ++i) keys[i] = source_.child_key(level, key, i);
  }
  std::uint64_t block(const Key& key) const {
    if (levels_ == source_.levels()) return source_.block(key);
    std::uint64_t block = 0;
    for (int i = 0; i < 8; ++i) {
      const Key child = source_.child_key(levels_ - 2, key, i);
      if (child != empty_key<kWords>())
        block |= std::uint64_t{source_.mask(levels_ - 1, child)} << (8 * i);
    }
    return block;
  }

 private:
  Source source_;
  int levels_;
};

}  // namespace

Svdag coarsen(const SvdagView& dag, int levels, Work work) {
  assert(levels >= kMinLevels && levels <= dag.levels);
  return rewrite(CoarsenRule(SourceDag(dag), levels), levels, work);
}

Svdag coarsen(const LongSvdagView& dag, int levels, Work work) {
  assert(levels >= kMinLevels && levels <= dag.levels);
  return rewrite(CoarsenRule(LongSourceDag(dag), levels), levels, work);
}

}  // namespace voxdag
