#pragma once
/// The bytes of a node while parts are merged.
///
///   leaf block   u64 mask
///   node         u8 child mask, one u40 id for each child
///
/// Ids are those of the children's level. The owner of an id is the mailbox id % mailboxes; it has
/// number id / mailboxes there.
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace voxdag {

inline constexpr int kIdBytes = 5;
inline constexpr std::uint64_t kMaxIds = std::uint64_t{1} << (8 * kIdBytes);
inline constexpr int kLeafRecordBytes = 8;
inline constexpr int kMaxRecordBytes = 1 + 8 * kIdBytes;

/// Returns the bytes of the record of a node with this child mask.
inline int node_record_bytes(std::uint8_t mask) { return 1 + kIdBytes * std::popcount(mask); }

inline void store_id(std::byte* at, std::uint64_t id) { std::memcpy(at, &id, kIdBytes); }

inline std::uint64_t load_id(const std::byte* at) {
  std::uint64_t id = 0;
  std::memcpy(&id, at, kIdBytes);
  return id;
}

/// Returns the bytes of the record that begins at `at`.
inline int record_bytes(const std::byte* at, bool is_leaf) {
  return is_leaf ? kLeafRecordBytes : node_record_bytes(static_cast<std::uint8_t>(*at));
}

/// Returns the number of ids in a record.
inline int record_ids(const std::byte* at, bool is_leaf) {
  return is_leaf ? 0 : std::popcount(static_cast<std::uint8_t>(*at));
}

/// Returns id `i` of the record of a node.
inline std::uint64_t record_id(const std::byte* at, int i) {
  return load_id(at + 1 + i * kIdBytes);
}

}  // namespace voxdag
