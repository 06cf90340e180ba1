#include "lab/compact/translations.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <numeric>
#include <tuple>

#include "lab/compact/symmetry.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag::lab {
namespace {

/// The hash of a view is the sum of kX^x kY^y kZ^z over its voxels, from where it is seen.
constexpr std::uint64_t kX = 0x9E3779B97F4A7C15u, kY = 0xC2B2AE3D27D4EB4Fu,
                        kZ = 0x165667B19E3779F9u;

constexpr int kMaxVoxels = CubeGrid::kMaxSize * CubeGrid::kMaxSize * CubeGrid::kMaxSize;

/// An image of a cube, and the hash of its voxels as seen from their lower corner.
struct ImageView {
  std::uint64_t hash = 0;
  std::uint32_t cube = 0;
  std::uint8_t symmetry = 0;
  std::array<std::uint8_t, 3> lo{};  ///< The lower corner: the empty layers below the voxels.

  Vec3i corner() const { return {lo[0], lo[1], lo[2]}; }
  /// Whether the views are equal but for the symmetry, as those of a symmetric cube are.
  bool is_same(const ImageView& other) const {
    return hash == other.hash && cube == other.cube && lo == other.lo;
  }
  friend bool operator<(const ImageView& a, const ImageView& b) {
    return std::tie(a.hash, a.cube, a.lo, a.symmetry) < std::tie(b.hash, b.cube, b.lo, b.symmetry);
  }
};

/// Returns the term of each voxel of a cube in the hash of its view from voxel 0.
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

ImageView make_view(const CubeGrid& cube, const GridMargins& margins, std::uint32_t number,
                    int symmetry, const std::vector<std::uint64_t>& terms) {
  const ImageIndex index(symmetry, cube.size);
  ImageView view{0, number, static_cast<std::uint8_t>(symmetry), {}};
  for (int axis = 0; axis < 3; ++axis) {
    const int from = kAxisOrders[symmetry / 8][axis];
    const bool is_mirrored = ((symmetry >> axis) & 1) != 0;
    view.lo[axis] = static_cast<std::uint8_t>(is_mirrored ? margins.hi[from] : margins.lo[from]);
  }
  const int corner = view.lo[0] + cube.size * (view.lo[1] + cube.size * view.lo[2]);
  for_each_voxel(cube, [&](int x, int y, int z) { view.hash += terms[index(x, y, z) - corner]; });
  return view;
}

/// The views of the images of all cubes that a move can make, by hash.
class ImageViews {
 public:
  explicit ImageViews(const std::vector<CubeGrid>& cubes) {
    if (cubes.empty()) return;
    std::vector<std::uint32_t> movable;
    for (std::size_t i = 0; i < cubes.size(); ++i)
      if (margins_of(cubes[i]).any()) movable.push_back(static_cast<std::uint32_t>(i));
    const std::vector<std::uint64_t> terms = hash_terms(cubes[0].size);
    views_.resize(movable.size() * kSymmetries);
    parallel_for(movable.size(), 64, [&](std::size_t i) {
      const CubeGrid& cube = cubes[movable[i]];
      const GridMargins margins = margins_of(cube);
      for (int s = 0; s < kSymmetries; ++s)
        views_[i * kSymmetries + s] = make_view(cube, margins, movable[i], s, terms);
    });
    std::sort(views_.begin(), views_.end());
    views_.erase(std::unique(views_.begin(), views_.end(),
                             [](const ImageView& a, const ImageView& b) { return a.is_same(b); }),
                 views_.end());
  }

  /// Keeps the views of cubes for which is_open(cube) is true.
  template <class IsOpen>
  void restrict_to(const IsOpen& is_open) {
    std::erase_if(views_, [&](const ImageView& view) { return !is_open(view.cube); });
    bits_ = std::max(16, static_cast<int>(std::bit_width(views_.size())) + kFilterBits);
    filter_.assign((std::size_t{1} << bits_) / 64, 0);
    for (const ImageView& view : views_)
      filter_[slot(view.hash) / 64] |= std::uint64_t{1} << (slot(view.hash) % 64);
    begins_.assign((std::size_t{1} << (bits_ - kFilterBits)) + 1, 0);
    for (const ImageView& view : views_) ++begins_[(slot(view.hash) >> kFilterBits) + 1];
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  }

  bool empty() const { return views_.empty(); }

  /// Calls use(view) for all views of this hash.
  template <class Use>
  void find(std::uint64_t hash, const Use& use) const {
    if (((filter_[slot(hash) / 64] >> (slot(hash) % 64)) & 1) == 0) return;
    const std::size_t bucket = slot(hash) >> kFilterBits;
    for (std::size_t i = begins_[bucket]; i < begins_[bucket + 1]; ++i)
      if (views_[i].hash == hash) use(views_[i]);
  }

 private:
  /// The filter has this many bits more than the buckets.
  static constexpr int kFilterBits = 4;

  std::size_t slot(std::uint64_t hash) const { return hash >> (64 - bits_); }

  std::vector<ImageView> views_;  ///< Sorted by hash.
  int bits_ = 16;
  std::vector<std::uint64_t> filter_;  ///< Bit slot(hash) is set if there may be views.
  std::vector<std::uint32_t> begins_;  ///< Of the views in each bucket, by the highest bits.
};

/// Writes the hash of the view from each voxel on.
void view_hashes(const CubeGrid& cube, std::array<std::uint64_t, kMaxVoxels>& hashes) {
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
    thread_local std::array<std::uint64_t, kMaxVoxels> hashes;
    for (int mirror = 0; mirror < kMirrors; ++mirror) {
      const CubeGrid cube = image_of_grid(mirror, cubes_[order_[rank]]);
      view_hashes(cube, hashes);
      const int n = cube.size;
      for (int i = 0; i < n * n * n; ++i) {
        const Vec3i from{i % n, i / n % n, i / n / n};
        if (!has_voxels_at_all_sides(hashes, from, i, n)) continue;
        views_.find(hashes[i], [&](const ImageView& view) {
          std::atomic<std::uint32_t>& best = best_[view.cube];
          std::uint32_t seen = best.load(std::memory_order_relaxed);
          const Vec3i by = view.corner() - from;
          if (rank >= seen || std::max({by.x, by.y, by.z}) > 0) return;
          if (!is_moved_grid(cube, by, image_of_grid(view.symmetry, cubes_[view.cube]))) return;
          while (rank < seen && !best.compare_exchange_weak(seen, rank)) {
          }
        });
      }
    }
  }

  /// Returns whether the view from voxel `i` has voxels in its first layer on each axis.
  static bool has_voxels_at_all_sides(const std::array<std::uint64_t, kMaxVoxels>& hashes,
                                      Vec3i from, int i, int n) {
    const std::uint64_t hash = hashes[i];
    return hash != (from.x == n - 1 ? 0 : hashes[i + 1] * kX) &&
           hash != (from.y == n - 1 ? 0 : hashes[i + n] * kY) &&
           hash != (from.z == n - 1 ? 0 : hashes[i + n * n] * kZ);
  }

  const std::vector<CubeGrid>& cubes_;
  std::vector<std::uint32_t> order_;  ///< Cubes by rank.
  ImageViews views_;
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

}  // namespace voxdag::lab
