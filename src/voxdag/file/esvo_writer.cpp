#include "voxdag/file/esvo_writer.hpp"

#include <cassert>
#include <cstring>

#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/stored/esvo/esvo.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kChunks = 3;
constexpr std::uint64_t kTableEnd = sizeof(VdagHeader) + kChunks * sizeof(VdagChunkEntry);

}  // namespace

EsvoFileWriter::EsvoFileWriter(const std::filesystem::path& path) : file_(path) {
  file_.write_zeros(vdag_align(kTableEnd));
}

void EsvoFileWriter::append(std::span<const std::uint64_t> slots) {
  // The info section of each block stores the block's size.
  for (std::size_t begin = 0; begin < slots.size();) {
    EsvoBlockInfo info;
    std::memcpy(&info, slots.data() + begin + slots[begin], sizeof info);
    assert(info.slots > 0 && begin + info.slots <= slots.size());
    block_checksums_.push_back(xxh3_64(std::as_bytes(slots.subspan(begin, info.slots))));
    begin += info.slots;
  }
  checksum_.add(std::as_bytes(slots));
  file_.write(slots);
  slots_ += slots.size();
}

std::uint64_t EsvoFileWriter::finish(std::vector<EsvoBlockEntry> directory,
                                     const EsvoMetadata& metadata) {
  assert(directory.size() == block_checksums_.size());
  for (std::size_t i = 0; i < directory.size(); ++i) directory[i].checksum = block_checksums_[i];
  const std::string json = esvo_metadata_json(metadata);
  try {
    parse_esvo_metadata(json);
  } catch (const Error& error) {
    throw error.in_file(file_.path().string());
  }

  const std::uint64_t begin = vdag_align(kTableEnd);
  VdagChunkEntry entries[kChunks];
  entries[0] = {kChunkEsvo, kVdagChunkRequired, begin, slots_ * 8, checksum_.digest()};
  const auto add = [&](std::size_t i, std::uint32_t id, std::span<const std::byte> bytes) {
    file_.write_zeros(vdag_align(file_.position()) - file_.position());
    entries[i] = {id, kVdagChunkRequired, file_.position(), bytes.size(), xxh3_64(bytes)};
    file_.write(bytes);
  };
  add(1, kChunkEsvoBlocks, std::as_bytes(std::span<const EsvoBlockEntry>(directory)));
  add(2, kChunkMeta, std::as_bytes(std::span<const char>(json)));
  file_.write_zeros(vdag_align(file_.position()) - file_.position());

  VdagHeader header{};
  std::memcpy(header.magic, kVdagMagic, sizeof kVdagMagic);
  header.version = kVdagVersion;
  header.chunk_count = kChunks;
  header.file_bytes = file_.position();
  std::vector<std::byte> head(kTableEnd);
  std::memcpy(head.data(), &header, sizeof header);
  std::memcpy(head.data() + sizeof header, entries, sizeof entries);
  header.checksum = xxh3_64(head);
  std::memcpy(head.data(), &header, sizeof header);
  file_.overwrite(0, head.data(), head.size());
  file_.commit();
  return header.file_bytes;
}

}  // namespace voxdag
