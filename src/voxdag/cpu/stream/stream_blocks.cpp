#include "voxdag/cpu/stream/stream_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {

StreamBlocks::StreamBlocks(const std::filesystem::path& path, std::uint64_t memory)
    : stream_(path, memory),
      wanted_(std::make_unique<std::atomic<bool>[]>(stream_.directory().size())),
      loaded_in_(stream_.directory().size()) {}

int StreamBlocks::depth(std::size_t block) const {
  int depth = 0;
  for (std::int64_t above = stream_.parent(block); above >= 0;
       above = stream_.parent(static_cast<std::size_t>(above)))
    ++depth;
  return depth;
}

std::vector<std::size_t> StreamBlocks::take_wanted() {
  std::vector<std::size_t> blocks;
  for (std::size_t i = 0; i < stream_.directory().size(); ++i)
    if (wanted_[i].exchange(false, std::memory_order_relaxed)) blocks.push_back(i);
  return blocks;
}

double StreamBlocks::apparent_size(std::size_t block, Vec3d eye) const {
  const EsvoBlockEntry& entry = stream_.directory()[block];
  const Grid& grid = stream_.grid();
  const double size = grid.cell_size(entry.level);
  const Vec3d lo = grid.origin + static_cast<Vec3d>(entry.cell) * size;
  const Vec3d nearest = max(lo, min(eye, lo + Vec3d{size, size, size})) - eye;
  return size / (std::sqrt(dot(nearest, nearest)) + 1e-9 * size);
}

bool StreamBlocks::make_room(std::size_t block) {
  while (!stream_.has_room(block)) {
    std::size_t oldest = loaded_in_.size();
    for (std::size_t i = 0; i < loaded_in_.size(); ++i)
      if (loaded_in_[i] < part_ && stream_.can_evict(i) &&
          (oldest == loaded_in_.size() || loaded_in_[i] < loaded_in_[oldest]))
        oldest = i;
    if (oldest == loaded_in_.size()) return false;
    stream_.evict(oldest);
  }
  return true;
}

void StreamBlocks::mark_above(std::size_t block) {
  for (std::int64_t above = stream_.parent(block); above >= 0;
       above = stream_.parent(static_cast<std::size_t>(above)))
    loaded_in_[above] = part_;
}

void StreamBlocks::evict_all() {
  for (bool has_evicted = true; has_evicted;) {
    has_evicted = false;
    for (std::size_t i = 0; i < loaded_in_.size(); ++i) {
      if (!stream_.can_evict(i)) continue;
      stream_.evict(i);
      has_evicted = true;
    }
  }
}

void StreamBlocks::load(std::size_t block) {
  ++part_;
  mark_above(block);
  while (!stream_.is_loaded(block)) {
    std::size_t next = block;
    while (!stream_.can_load(next)) next = static_cast<std::size_t>(stream_.parent(next));
    // Without other blocks, a block and its ancestors fit into memory together.
    if (!make_room(next)) {
      evict_all();
      continue;
    }
    stream_.load(next);
    loaded_in_[next] = part_;
  }
}

std::size_t StreamBlocks::load_missing(Vec3d eye) {
  std::vector<std::size_t> wanted = take_wanted();
  std::size_t loaded = 0;
  std::vector<double> sizes(stream_.directory().size());
  for (const std::size_t block : wanted) sizes[block] = apparent_size(block, eye);
  std::stable_sort(wanted.begin(), wanted.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  for (const std::size_t block : wanted) {
    mark_above(block);
    // Making room for one block may have evicted the parent of another.
    if (stream_.is_loaded(block) || !stream_.can_load(block)) continue;
    if (!make_room(block)) continue;
    stream_.load(block);
    loaded_in_[block] = part_;
    ++loaded;
  }
  return loaded;
}

}  // namespace voxdag
