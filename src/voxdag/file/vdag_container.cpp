#include "voxdag/file/vdag_container.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/file_copy.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/vdag_format.hpp"

namespace voxdag {
namespace {

/// The bytes of a file and what they cost.
struct Owner {
  MemoryReservation memory;
  std::optional<FileCopy> copy;
  std::optional<MappedFile> mapping;
  std::vector<std::uint64_t> head;  ///< The first bytes of a file that is no container.
};

/// Reads `bytes` at `offset`, fewer at the end of the file. Returns their number.
std::size_t read_at(const OpenInput& input, const std::filesystem::path& path, std::size_t offset,
                    void* data, std::size_t bytes) {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t got = ::pread(input.descriptor.get(), static_cast<char*>(data) + done,
                                bytes - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      throw Error(path.string(), ErrorPlace::byte(offset + done),
                  "cannot read: " + std::system_category().message(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

/// Returns whether the chunk table, which is not checked, names the chunk NODX.
bool names_long_nodes(const OpenInput& input, const std::filesystem::path& path,
                      const VdagHeader& header) {
  std::vector<VdagChunkEntry> table(std::min<std::size_t>(header.chunk_count, kVdagMaxChunks));
  table.resize(
      read_at(input, path, sizeof header, table.data(), table.size() * sizeof(VdagChunkEntry)) /
      sizeof(VdagChunkEntry));
  return std::any_of(table.begin(), table.end(),
                     [](const VdagChunkEntry& entry) { return entry.id == kChunkLongNodes; });
}

/// Throws Error if the file is no container. Reads only its chunk table.
void check_chunk_table(const OpenInput& input, const std::filesystem::path& path) {
  const MappedFile mapping(input, path, MappedFile::Access::kRandom);
  with_file_name(path.string(), [&] { read_vdag_chunks(mapping.bytes()); });
}

}  // namespace

VdagKind kind_of(const std::vector<VdagChunk>& chunks) {
  if (has_chunk(chunks, kChunkEsvo)) return VdagKind::kEsvo;
  if (has_chunk(chunks, kChunkCompactStream)) return VdagKind::kCompact;
  return has_chunk(chunks, kChunkLongNodes) ? VdagKind::kLong : VdagKind::kPlain;
}

VdagKind vdag_kind(const std::filesystem::path& path) {
  const MappedFile mapping(path, MappedFile::Access::kRandom);
  return with_file_name(path.string(), [&] { return kind_of(read_vdag_chunks(mapping.bytes())); });
}

VdagContainer::VdagContainer(const std::filesystem::path& path, MemoryBudget* memory)
    : path_(path) {
  const OpenInput input = open_input(path);
  const auto owner = std::make_shared<Owner>();
  VdagHeader header{};
  const std::size_t got = read_at(input, path, 0, &header, sizeof header);
  if (got < sizeof header || std::memcmp(header.magic, kVdagMagic, sizeof header.magic) != 0) {
    // A large file of another format is refused without reading it: its head has the reason.
    owner->head.resize((sizeof header + 7) / 8);
    std::memcpy(owner->head.data(), &header, got);
    bytes_ = std::as_bytes(std::span(owner->head)).first(got);
  } else if (names_long_nodes(input, path, header)) {
    bytes_ = owner->mapping.emplace(input, path, MappedFile::Access::kSequential).bytes();
  } else {
    try {
      owner->memory = MemoryReservation(memory, *input.size);
    } catch (const OverMemory&) {
      check_chunk_table(input, path);  // More memory would not help with a damaged file.
      throw;
    }
    bytes_ = owner->copy.emplace(input, path).bytes();
  }
  owner_ = owner;
}

std::vector<VdagChunk> VdagContainer::chunks() const {
  return with_file_name(path_.string(), [&] { return read_vdag_chunks(bytes_); });
}

bool VdagContainer::is(VdagKind kind) const {
  try {
    return kind_of(read_vdag_chunks(bytes_)) == kind;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace voxdag
