#pragma once
/// Mutates files of chunks (docs/format.md): splits them, changes the chunks, and joins them with
/// correct offsets and checksums, so that mutations reach the checks after the checksums.
#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_format.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace voxdag {

/// A chunk of a file.
struct Piece {
  VdagChunkEntry entry;
  std::string bytes;
};

/// Returns the chunks of a file, at most 8; stops at the first damaged table entry.
inline std::vector<Piece> split_chunks(const std::string& file) {
  std::vector<Piece> pieces;
  if (file.size() < sizeof(VdagHeader)) return pieces;
  const auto count = peek<VdagHeader>(file, 0).chunk_count;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 8); ++i) {
    if (entry_offset(i + 1) > file.size()) break;
    const auto entry = peek<VdagChunkEntry>(file, entry_offset(i));
    if (entry.offset > file.size() || entry.length > file.size() - entry.offset) break;
    pieces.push_back({entry, file.substr(entry.offset, entry.length)});
  }
  return pieces;
}

/// Returns a file with these chunks.
inline std::string join_chunks(const std::vector<Piece>& pieces) {
  std::string file(vdag_align(entry_offset(pieces.size())), '\0');
  VdagHeader header{};
  std::memcpy(header.magic, kVdagMagic, sizeof kVdagMagic);
  header.version = kVdagVersion;
  header.chunk_count = static_cast<std::uint32_t>(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    VdagChunkEntry entry = pieces[i].entry;
    entry.offset = file.size();
    entry.length = pieces[i].bytes.size();
    poke(file, entry_offset(i), entry);
    file += pieces[i].bytes;
    file.resize(vdag_align(file.size()));
  }
  header.file_bytes = file.size();
  poke(file, 0, header);
  repair_checksums(file);
  return file;
}

/// Changes one word slightly, or copies one word over another. The result is often still a valid
/// DAG.
template <class T>
void change_word(std::string& bytes, std::mt19937& rng) {
  const std::size_t count = bytes.size() / sizeof(T);
  if (count == 0) return;
  const auto offset = [&] { return rng() % count * sizeof(T); };
  const std::size_t to = offset();
  T value = peek<T>(bytes, offset());
  if (rng() % 2 == 0) value = static_cast<T>(peek<T>(bytes, to) + static_cast<T>(rng() % 9) - 4);
  if (rng() % 4 == 0) value ^= T{1} << rng() % (8 * sizeof(T));
  poke(bytes, to, value);
}

inline void change_bytes(std::string& bytes) {
  const std::size_t size = bytes.size(), most = size + 64;
  bytes.resize(most);
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, most));
}

/// Flips a bit of a chunk's id or flags in the table.
inline void change_entry(VdagChunkEntry& entry, std::mt19937& rng) {
  std::string bytes(sizeof entry, '\0');
  poke(bytes, 0, entry);
  bytes[rng() % 8] ^= static_cast<char>(1 << rng() % 8);
  entry = peek<VdagChunkEntry>(bytes, 0);
}

/// Mutates a file for LLVMFuzzerCustomMutator. `change(pieces, rng)` changes one of the chunks (at
/// least one); `seed_file(rng)` returns any small valid file.
template <class Change, class SeedFile>
std::size_t mutate_chunks(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed,
                          const Change& change, const SeedFile& seed_file) {
  std::mt19937 rng(seed);
  if (rng() % 32 == 0) return LLVMFuzzerMutate(data, size, max_size);
  std::vector<Piece> pieces = split_chunks(std::string(reinterpret_cast<const char*>(data), size));
  std::string file;
  if (pieces.empty() || rng() % 256 == 0) {
    file = seed_file(rng);
  } else {
    for (unsigned i = 0; i <= rng() % 4; ++i) change(pieces, rng);
    file = join_chunks(pieces);
  }
  if (file.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, file.data(), file.size());
  return file.size();
}

/// Calls walk(parse(bytes)) for LLVMFuzzerTestOneInput, and ignores an Error of `parse`.
template <class Parse, class Walk>
int read_and_walk(const std::uint8_t* data, std::size_t size, const Parse& parse,
                  const Walk& walk) {
  const AlignedBytes bytes(std::string(reinterpret_cast<const char*>(data), size));
  try {
    walk(parse(bytes.span()));
  } catch (const Error&) {
  }
  return 0;
}

}  // namespace voxdag
