#include "bench/compact/translations.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <numeric>

#include "bench/compact/symmetry.hpp"
#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// The hash of a view is the sum of kX^x kY^y kZ^z over its voxels, from where it is seen.
constexpr std::uint64_t kX = 0x9E3779B97F4A7C15u, kY = 0xC2B2AE3D27D4EB4Fu,
                        kZ = 0x165667B19E3779F9u;

constexpr int kMostVoxels = CubeGrid::kMostSize * CubeGrid::kMostSize * CubeGrid::kMostSize;

/// An image of a cube, and the hash of its view from the lower corner.
struct CornerView {
  std::uint64_t hash = 0;
  std::uint32_t cube = 0;
  std::uint8_t symmetry = 0;

  auto operator<=>(const CornerView&) const = default;
};

/// Returns the term of each voxel of a cube in the hash of its view from the lower corner.
std::vector<std::uint64_t> hash_terms(int size) {
  std::vector<std::uint64_t> terms;
  std::uint64_t at_z = 1;
  for (int z = 0; z < size; ++z, at_z *= kZ) {
    std::uint64_t at_y = at_z;
    for (int y = 0; y < size; ++y, at_y *= kY) {
      std::uint64_t at_x = at_y;
      for (int x = 0; x < size; ++x, at_x *= kX) terms.push_back(at_x);
    }
  }
  return terms;
}

/// The corner views of the images of all cubes that a move can make, by hash.
class CornerViews {
 public:
  explicit CornerViews(const std::vector<CubeGrid>& cubes) {
    if (cubes.empty()) return;
    std::vector<std::uint32_t> movable;
    for (std::size_t i = 0; i < cubes.size(); ++i)
      if (margins_of(cubes[i]).any()) movable.push_back(static_cast<std::uint32_t>(i));
    const std::vector<std::uint64_t> terms = hash_terms(cubes[0].size);
    views_.resize(movable.size() * kSymmetries);
    parallel_for(movable.size(), 64, [&](std::size_t i) {
      for (int s = 0; s < kSymmetries; ++s) {
        CornerView& view = views_[i * kSymmetries + s];
        view = {0, movable[i], static_cast<std::uint8_t>(s)};
        const ImageIndex index(s, cubes[movable[i]].size);
        for_each_voxel(cubes[movable[i]],
                       [&](int x, int y, int z) { view.hash += terms[index(x, y, z)]; });
      }
    });
    std::sort(views_.begin(), views_.end());
    // A cube that is its own image has views of equal hash; one of them is enough.
    views_.erase(std::unique(views_.begin(), views_.end(),
                             [](const CornerView& a, const CornerView& b) {
                               return a.hash == b.hash && a.cube == b.cube;
                             }),
                 views_.end());
  }

  /// Keeps the views of cubes for which is_open(cube) is true.
  template <class IsOpen>
  void restrict_to(const IsOpen& is_open) {
    std::erase_if(views_, [&](const CornerView& view) { return !is_open(view.cube); });
    bits_ = std::max(16, static_cast<int>(std::bit_width(views_.size())) + 3);
    filter_.assign((std::size_t{1} << bits_) / 64, 0);
    for (const CornerView& view : views_)
      filter_[slot(view.hash) / 64] |= std::uint64_t{1} << (slot(view.hash) % 64);
  }

  bool empty() const { return views_.empty(); }

  /// Calls use(view) for all views of this hash.
  template <class Use>
  void find(std::uint64_t hash, const Use& use) const {
    if (((filter_[slot(hash) / 64] >> (slot(hash) % 64)) & 1) == 0) return;
    for (auto at = std::lower_bound(views_.begin(), views_.end(), CornerView{hash, 0, 0});
         at != views_.end() && at->hash == hash; ++at)
      use(*at);
  }

 private:
  std::size_t slot(std::uint64_t hash) const { return hash >> (64 - bits_); }

  std::vector<CornerView> views_;
  int bits_ = 16;
  std::vector<std::uint64_t> filter_;  ///< Bit slot(hash) is set if there may be views.
};

/// Writes the hash of the view from each voxel on.
void view_hashes(const CubeGrid& cube, std::array<std::uint64_t, kMostVoxels>& hashes) {
  const int n = cube.size;
  for (int x = n - 1; x >= 0; --x)
    for (int i = 0; i < n * n; ++i) {
      const std::uint64_t behind = x == n - 1 ? 0 : hashes[x + 1 + n * i];
      hashes[x + n * i] = behind * kX + ((cube.rows[i] >> x) & 1);
    }
  for (int z = 0; z < n; ++z)
    for (int i = n * (n - 1) - 1; i >= 0; --i)
      hashes[i + n * n * z] += hashes[i + n + n * n * z] * kY;
  for (int i = n * n * (n - 1) - 1; i >= 0; --i) hashes[i] += hashes[i + n * n] * kZ;
}

class Search {
 public:
  explicit Search(const std::vector<CubeGrid>& cubes)
      : cubes_(cubes), order_(cubes.size()), views_(cubes), best_(cubes.size()) {
    std::vector<int> counts(cubes.size());
    for (std::size_t i = 0; i < cubes.size(); ++i) counts[i] = cubes[i].count();
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return counts[a] > counts[b]; });
    for (std::size_t rank = 0; rank < order_.size(); ++rank)
      best_[order_[rank]] = static_cast<std::uint32_t>(rank);
  }

  std::vector<std::uint32_t> run(const Progress& progress) {
    // After each part, cubes with a source are settled: later sources have larger ranks.
    const std::size_t part = std::max<std::size_t>(order_.size() / 16, 1024);
    for (std::size_t begin = 0; begin < order_.size(); begin += part) {
      views_.restrict_to([&](std::uint32_t cube) { return best_[cube].load() >= begin; });
      if (views_.empty()) break;
      parallel_for(std::min(part, order_.size() - begin), 16, [&](std::size_t i) {
        if (i % 16 == 0) progress.throw_if_cancelled();
        look_up(static_cast<std::uint32_t>(begin + i));
      });
    }
    std::vector<std::uint32_t> sources(cubes_.size());
    for (std::size_t i = 0; i < sources.size(); ++i) sources[i] = order_[best_[i].load()];
    return sources;
  }

 private:
  void look_up(std::uint32_t rank) {
    thread_local std::array<std::uint64_t, kMostVoxels> hashes;
    for (int mirror = 0; mirror < kMirrors; ++mirror) {
      const CubeGrid cube = image_of_grid(mirror, cubes_[order_[rank]]);
      view_hashes(cube, hashes);
      const int n = cube.size;
      for (int i = 0; i < n * n * n; ++i) {
        if (hashes[i] == 0) continue;
        views_.find(hashes[i], [&](const CornerView& view) {
          std::atomic<std::uint32_t>& best = best_[view.cube];
          std::uint32_t seen = best.load(std::memory_order_relaxed);
          if (rank >= seen) return;
          const Vec3i by{-(i % n), -(i / n % n), -(i / n / n)};
          if (!is_moved_grid(cube, by, image_of_grid(view.symmetry, cubes_[view.cube]))) return;
          while (rank < seen && !best.compare_exchange_weak(seen, rank)) {
          }
        });
      }
    }
  }

  const std::vector<CubeGrid>& cubes_;
  std::vector<std::uint32_t> order_;  ///< Cubes by rank.
  CornerViews views_;
  std::vector<std::atomic<std::uint32_t>> best_;  ///< For each cube, the smallest rank of a source.
};

}  // namespace

std::vector<std::uint32_t> find_sources(const std::vector<CubeGrid>& cubes,
                                        const Progress& progress) {
  return Search(cubes).run(progress);
}

Transform first_transform(const CubeGrid& source, const CubeGrid& cube) {
  const GridMargins margins = margins_of(cube);
  for (int s = 0; s < kSymmetries; ++s) {
    const CubeGrid image = image_of_grid(s, source);
    for (int z = -margins.hi.z; z <= margins.lo.z; ++z)
      for (int y = -margins.hi.y; y <= margins.lo.y; ++y)
        for (int x = -margins.hi.x; x <= margins.lo.x; ++x)
          if (is_moved_grid(image, {x, y, z}, cube))
            return {static_cast<std::uint8_t>(s), {x, y, z}};
  }
  assert(false);
  return {};
}

}  // namespace voxdag
