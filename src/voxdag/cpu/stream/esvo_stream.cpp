#include "voxdag/cpu/stream/esvo_stream.hpp"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/file/esvo_parse.hpp"
#include "voxdag/file/vdag_container.hpp"
#include "voxdag/stored/esvo/validate_esvo.hpp"

namespace voxdag {

void EsvoStream::fail(ErrorPlace place, const std::string& reason) const {
  throw Error(path_.string(), std::move(place), reason);
}

EsvoStream::EsvoStream(const std::filesystem::path& path, std::uint64_t memory)
    : path_(path), file_(open_input(path)) {
  {
    // The mapping ends with this scope, before any walk, and its blocks are never read.
    const MappedFile mapping(file_, path, MappedFile::Access::kRandom);
    try {
      const std::vector<VdagChunk> chunks = read_vdag_chunks(mapping.bytes());
      if (kind_of(chunks) != VdagKind::kEsvo)
        throw Error("", "", "--memory is for ESVOs only, but this file is a DAG");
      check_vdag_checksums(chunks_but_blocks(chunks));
      metadata_ = read_esvo_metadata(chunks);
      const auto directory = read_esvo_directory(chunks);
      directory_.assign(directory.begin(), directory.end());
      slots_offset_ = esvo_chunk_offset(chunks);
    } catch (const Error& error) {
      throw error.in_file(path_.string());
    }
  }
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < directory_.size(); ++i) {
    if (directory_[i].begin != end || directory_[i].slots == 0 ||
        directory_[i].slots % kEsvoPageSlots != 0)
      fail(ErrorPlace::block(i), "its place in the directory does not follow the previous block");
    end += directory_[i].slots;
  }
  if (directory_.empty()) return;  // no voxels
  find_children();
  const std::uint64_t wanted = std::min(memory / 8, end);
  pool_.resize(wanted / kEsvoPageSlots * kEsvoPageSlots);
  cut_.resize(pool_.size() / 32);
  if (!pool_.empty()) free_[0] = pool_.size();

  const auto root = static_cast<std::size_t>(
      std::find_if(blocks_.begin(), blocks_.end(), [](const Block& b) { return b.parent < 0; }) -
      blocks_.begin());
  if (root == blocks_.size()) fail("directory", "has no root block");
  if (const std::uint64_t least = most_slots_of_a_path(); pool_.size() < least)
    fail("", "the memory limit is too small: a block and its ancestors need " +
                 std::to_string(least * 8) + " bytes");
  blocks_[root].siblings = {Vec3i{}};
  load(root);
  const std::uint64_t at = blocks_[root].position;
  root_ = at + view().info(at).first_descriptor;
  if (metadata_.root != directory_[root].begin + view().info(at).first_descriptor)
    fail("root", "is not the first descriptor of its block");
}

void EsvoStream::read(std::uint64_t offset, void* data, std::size_t bytes) const {
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t got = pread(file_.descriptor.get(), static_cast<char*>(data) + done, bytes - done,
                              static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(ErrorPlace::byte(offset + done), std::strerror(errno));
    if (got == 0) fail(ErrorPlace::byte(offset + done), "the file was truncated while it was read");
    done += static_cast<std::size_t>(got);
  }
}

void EsvoStream::find_children() {
  blocks_.resize(directory_.size());
  for (std::size_t i = 0; i < directory_.size(); ++i) {
    const std::uint64_t parent = directory_[i].parent;
    if (parent == EsvoBlockEntry::kNoParent) continue;
    const auto after = std::upper_bound(
        directory_.begin(), directory_.end(), parent,
        [](std::uint64_t slot, const EsvoBlockEntry& b) { return slot < b.begin; });
    const auto above = static_cast<std::size_t>(after - directory_.begin()) - 1;
    if (above == i || parent >= directory_[above].begin + directory_[above].slots)
      fail(ErrorPlace::block(i), "its parent slot is not in another block");
    blocks_[i].parent = static_cast<std::int64_t>(above);
    blocks_[i].parent_slot = static_cast<std::uint32_t>(parent - directory_[above].begin);
    blocks_[above].children.push_back(static_cast<std::uint32_t>(i));
  }
}

/// Returns the greatest number of slots of a block and its ancestors. Throws if blocks form a
/// cycle.
std::uint64_t EsvoStream::most_slots_of_a_path() const {
  std::uint64_t most = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    std::uint64_t slots = 0;
    int blocks = 0;
    for (auto at = static_cast<std::int64_t>(i); at >= 0; at = blocks_[at].parent) {
      slots += directory_[at].slots;
      if (++blocks > kMaxLevels) fail(ErrorPlace::block(i), "has too many ancestor blocks");
    }
    most = std::max(most, slots);
  }
  return most;
}

bool EsvoStream::can_load(std::size_t block) const {
  const std::int64_t parent = blocks_[block].parent;
  return parent < 0 || is_loaded(static_cast<std::size_t>(parent));
}

bool EsvoStream::has_room(std::size_t block) const {
  return std::any_of(free_.begin(), free_.end(),
                     [&](const auto& range) { return range.second >= directory_[block].slots; });
}

std::uint64_t EsvoStream::allocate(std::uint32_t slots) {
  for (auto range = free_.begin(); range != free_.end(); ++range) {
    if (range->second < slots) continue;
    const auto [begin, length] = *range;
    free_.erase(range);
    if (length > slots) free_[begin + slots] = length - slots;
    return begin;
  }
  assert(false);
  return 0;
}

void EsvoStream::release(std::uint64_t position, std::uint32_t slots) {
  auto range = free_.emplace(position, slots).first;
  const auto next = std::next(range);
  if (next != free_.end() && range->first + range->second == next->first) {
    range->second += next->second;
    free_.erase(next);
  }
  if (range == free_.begin()) return;
  const auto before = std::prev(range);
  if (before->first + before->second != range->first) return;
  before->second += range->second;
  free_.erase(range);
}

void EsvoStream::mark(std::uint64_t slot, bool is_cut) {
  const std::uint32_t bit = 1u << slot % 32;
  cut_[slot / 32] = is_cut ? cut_[slot / 32] | bit : cut_[slot / 32] & ~bit;
}

void EsvoStream::cut(std::size_t block) {
  Block& b = blocks_[block];
  Block& parent = blocks_[b.parent];
  const std::uint64_t slot = parent.position + b.parent_slot;
  ChildDescriptor descriptor = ChildDescriptor::from_slot(pool_[slot]);
  b.descriptor = descriptor.children;
  descriptor.children = (descriptor.children & ~0xFFu) | descriptor.valid_mask();
  pool_[slot] = descriptor.to_slot();
  pool_[slot + descriptor.child_pointer()] = block;
  mark(slot, true);
  parent.version = version_;
}

void EsvoStream::attach(std::size_t block, std::uint32_t first_descriptor) {
  const Block& b = blocks_[block];
  Block& parent = blocks_[b.parent];
  const std::uint64_t slot = parent.position + b.parent_slot;
  ChildDescriptor descriptor = ChildDescriptor::from_slot(pool_[slot]);
  descriptor.children = b.descriptor;
  const std::int64_t distance =
      static_cast<std::int64_t>(b.position + first_descriptor) - static_cast<std::int64_t>(slot);
  pool_[slot + descriptor.child_pointer()] =
      static_cast<std::uint32_t>(static_cast<std::int32_t>(distance));
  pool_[slot] = descriptor.to_slot();
  mark(slot, false);
  parent.version = version_;
}

void EsvoStream::load(std::size_t block) {
  assert(!is_loaded(block) && can_load(block));
  const EsvoBlockEntry& entry = directory_[block];
  Block& b = blocks_[block];
  const ErrorPlace place = ErrorPlace::block(block);
  const std::uint64_t position = allocate(entry.slots);
  const std::span<std::uint64_t> slots(pool_.data() + position, entry.slots);
  EsvoBlockCheck check;
  try {
    read(slots_offset_ + entry.begin * 8, slots.data(), slots.size_bytes());
    if (xxh3_64(std::as_bytes(slots)) != entry.checksum) fail(place, "checksum is wrong");
    check = check_esvo_block(slots, entry, b.siblings, metadata_.grid.levels);
    if (check.links.size() != b.children.size())
      fail(place, "the directory disagrees with the child blocks");
    for (EsvoFarLink& link : check.links) {
      const auto child = std::find_if(b.children.begin(), b.children.end(), [&](std::uint32_t c) {
        return blocks_[c].parent_slot == link.slot;
      });
      if (child == b.children.end() || directory_[*child].level != link.level ||
          directory_[*child].cell != link.cell)
        fail(place / ErrorPlace::slot(link.slot),
             "the directory disagrees with this slot about its child block");
      blocks_[*child].siblings = std::move(link.siblings);
    }
  } catch (const Error& error) {
    release(position, entry.slots);
    if (!error.file().empty()) throw;
    throw error.within(place).in_file(path_.string());
  }
  b.position = position;
  b.version = ++version_;
  for (const std::uint32_t child : b.children) cut(child);
  if (b.parent >= 0) {
    attach(block, view().info(position).first_descriptor);
    ++blocks_[b.parent].loaded_children;
  }
  ++counts_.blocks_loaded;
  counts_.blocks_used += b.was_loaded ? 0 : 1;
  b.was_loaded = true;
  ++counts_.blocks_read;
  counts_.bytes_loaded += slots.size_bytes();
  counts_.bytes_read += slots.size_bytes();
}

std::vector<SlotRange> EsvoStream::changes_since(std::uint64_t version) const {
  std::vector<SlotRange> ranges;
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    if (is_loaded(i) && blocks_[i].version > version)
      ranges.push_back({blocks_[i].position, directory_[i].slots});
  return ranges;
}

bool EsvoStream::can_evict(std::size_t block) const {
  return is_loaded(block) && blocks_[block].parent >= 0 && blocks_[block].loaded_children == 0;
}

void EsvoStream::evict(std::size_t block) {
  assert(can_evict(block));
  Block& b = blocks_[block];
  ++version_;
  for (const std::uint32_t child : b.children) mark(b.position + blocks_[child].parent_slot, false);
  // cut() keeps the position of the far pointer in the descriptor, and attach() needs nothing else.
  cut(block);
  --blocks_[b.parent].loaded_children;
  release(b.position, directory_[block].slots);
  b.position = kNowhere;
  --counts_.blocks_loaded;
  ++counts_.blocks_evicted;
  counts_.bytes_loaded -= std::uint64_t{directory_[block].slots} * 8;
}

}  // namespace voxdag
