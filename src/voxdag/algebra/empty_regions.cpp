#include "voxdag/algebra/empty_regions.hpp"

#include "voxdag/algebra/select_regions.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// Selects regions by a list. Nodes that occur several times may be filled differently: a state
/// says which closed regions of a cell and of those below it are filled. Equal ones have equal
/// numbers; 0: none.
class ListedRegions {
 public:
  static constexpr bool kKeepsVoxels = true;

  ListedRegions(const Regions& regions, const std::vector<bool>& is_filled)
      : regions_(regions), is_filled_(is_filled), next_(regions.counts(0, root()).open) {
    numbers_.try_emplace(Entry{}, 0);
    entries_.push_back({});
    root_state_ = state_of(0, root());
  }

  bool is_open_selected(std::uint32_t region) const { return is_filled_[region]; }
  bool is_closed_selected(int level, std::uint32_t node, std::uint32_t region,
                          std::uint32_t state) const {
    return sets_.contains(entries_[state][8], region - regions_.counts(level, node).open);
  }
  std::uint32_t root_state() const { return root_state_; }
  std::uint32_t state_below(std::uint32_t state, int child) const {
    return entries_[state][static_cast<std::size_t>(child)];
  }

 private:
  /// The states of the children, then the set of the cell's own closed regions.
  using Entry = std::array<std::uint32_t, 9>;

  std::uint32_t root() const { return regions_.source().root(); }

  /// Visits the cells in the order of EmptyRegions::places().
  std::uint32_t state_of(int level, std::uint32_t node) {
    Entry entry{};
    const std::uint32_t closed = regions_.counts(level, node).closed;
    const std::size_t first = next_;
    next_ += closed;
    entry[8] = sets_.add(closed, [&](std::uint32_t i) { return is_filled_[first + i]; });
    if (level < regions_.levels() - 2)
      for (int child = 0; child < 8; ++child) {
        const std::uint32_t below = regions_.source().child(level, node, child);
        if (regions_.has_closed(level + 1, below))
          entry[static_cast<std::size_t>(child)] = state_of(level + 1, below);
      }
    const auto added = numbers_.try_emplace(entry, static_cast<std::uint32_t>(entries_.size()));
    if (added.second) entries_.push_back(entry);
    return added.first->second;
  }

  const Regions& regions_;
  const std::vector<bool>& is_filled_;
  std::size_t next_;
  RegionSets sets_;
  std::map<Entry, std::uint32_t> numbers_;
  std::vector<Entry> entries_;
  std::uint32_t root_state_ = 0;
};

}  // namespace

EmptyRegions::EmptyRegions(const SvdagView& dag, Work work)
    : regions_(std::make_unique<Regions>(dag, RegionKind::kEmpty, Neighbours::k6, work)),
      work_(work) {
  const std::uint32_t root = regions_->source().root();
  for (std::uint32_t i = 0; i < regions_->counts(0, root).open; ++i)
    places_.push_back(regions_->place_in(0, root, i));
  add_places(0, root, {});
}

EmptyRegions::~EmptyRegions() = default;

void EmptyRegions::add_places(int level, std::uint32_t node, Vec3i first) {
  const Regions::Counts counts = regions_->counts(level, node);
  for (std::uint32_t i = 0; i < counts.closed; ++i)
    places_.push_back(first + regions_->place_in(level, node, counts.open + i));
  if (level == regions_->levels() - 2) return;
  const std::int32_t half = std::int32_t{1} << (regions_->levels() - level - 1);
  for (int child = 0; child < 8; ++child) {
    const std::uint32_t below = regions_->source().child(level, node, child);
    if (!regions_->has_closed(level + 1, below)) continue;
    add_places(level + 1, below, first + child_offset(child) * half);
  }
}

Svdag EmptyRegions::fill(const std::vector<bool>& is_filled) const {
  return select_regions(*regions_, ListedRegions(*regions_, is_filled), work_);
}

}  // namespace voxdag
