#include "voxdag/algebra/attributes/channel_of_voxels.hpp"

#include <bit>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"

namespace voxdag {
namespace {

class ChannelWalk {
 public:
  ChannelWalk(const SvdagView& dag, const CellIndexView& index, ChannelKind kind,
              const std::function<double(Vec3i)>& value_of, Work work)
      : dag_(dag),
        index_(index),
        kind_(kind),
        value_of_(value_of),
        work_(work),
        codes_(work.memory) {
    codes_.resize(index.cells);
    if (!dag.is_empty()) visit({}, {});
  }

  std::span<const std::int32_t> codes() const { return codes_; }

 private:
  struct Sum {
    double sum = 0;
    std::uint64_t weight = 0;
  };

  void add_voxels(const NumberedCell& cell, Vec3i place, Sum& sum) {
    if (cell.level == dag_.levels) {
      sum.sum += value_of_(place);
      ++sum.weight;
      return;
    }
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      add_voxels(child_of(dag_, index_, cell, child), place * 2 + child_offset(child), sum);
    }
  }

  /// Sets the codes of a subtree. Returns the value of the cell times its weight.
  Sum visit(const NumberedCell& cell, Vec3i place) {
    if (cell.level == dag_.levels - 2) work_.poll_seldom(blocks_++);
    Sum sum;
    const bool is_finest = cell.level == index_.finest_level;
    if (is_finest) {
      add_voxels(cell, place, sum);
    } else {
      for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1) {
        const int child = std::countr_zero(left);
        const Sum below =
            visit(child_of(dag_, index_, cell, child), place * 2 + child_offset(child));
        sum.sum += below.sum;
        sum.weight += below.weight;
      }
    }
    const std::int32_t code = channel_code(kind_, sum.sum / static_cast<double>(sum.weight));
    codes_[cell.number] = code;
    const std::uint64_t weight = is_finest ? 1 : sum.weight;
    return {value_of_code(kind_, code) * static_cast<double>(weight), weight};
  }

  const SvdagView& dag_;
  const CellIndexView& index_;
  ChannelKind kind_;
  const std::function<double(Vec3i)>& value_of_;
  Work work_;
  CountedVector<std::int32_t> codes_;
  std::uint64_t blocks_ = 0;
};

}  // namespace

EncodedChannel channel_of_voxels(const SvdagView& dag, const CellIndexView& index,
                                 const ChannelSpec& spec,
                                 const std::function<double(Vec3i)>& value_of, Work work) {
  check_channel(spec);
  const ChannelWalk walk(dag, index, spec.kind, value_of, work);
  return encode_channel(spec, walk.codes(), work);
}

}  // namespace voxdag
