// Tests the reader with damaged files: every truncation, every bit flip, and faults with correct
// checksums.
#include <gtest/gtest.h>

#include <array>

#include "support/damaged_bytes.hpp"
#include "support/error_of.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_parse.hpp"

namespace voxdag {
namespace {

std::string vdag_error_of(const std::string& bytes) {
  return voxdag::error_of([&] { parse_vdag(AlignedBytes(bytes).span()); });
}

std::string small_vdag_file() { return vdag_file_bytes(brute_svdag(4, {{0, 0, 0}, {15, 15, 15}})); }

/// Returns the bytes with one value changed and the checksums corrected.
template <class T>
std::string repaired_with(std::size_t offset, T value) {
  std::string bytes = small_vdag_file();
  poke(bytes, offset, value);
  repair_checksums(bytes);
  return bytes;
}

std::size_t chunk_offset(const std::string& bytes, std::size_t index) {
  return peek<VdagChunkEntry>(bytes, entry_offset(index)).offset;
}

TEST(VdagCorruption, TheSmallFileIsValid) {
  EXPECT_EQ(vdag_error_of(small_vdag_file()), "no error");
}

TEST(VdagCorruption, EveryTruncationIsRefused) {
  expect_truncations_are_refused(small_vdag_file(),
                                 [](const std::string& b) { return vdag_error_of(b); });
}

TEST(VdagCorruption, EveryTruncationIsRefusedEvenIfTheHeaderAgrees) {
  const std::string whole = small_vdag_file();
  for (std::size_t size = sizeof(VdagHeader); size < whole.size(); ++size) {
    std::string bytes = whole.substr(0, size);
    poke(bytes, offsetof(VdagHeader, file_bytes), std::uint64_t{size});
    repair_checksums(bytes);
    EXPECT_NE(vdag_error_of(bytes), "no error") << size << " bytes";
  }
}

TEST(VdagCorruption, EveryBitFlipIsRefused) {
  expect_bit_flips_are_refused(small_vdag_file(),
                               [](const std::string& b) { return vdag_error_of(b); });
}

/// With correct checksums, a flip may make another valid file, which must be safe to count.
TEST(VdagCorruption, EveryBitFlipWithRightChecksumsIsSurvived) {
  const std::string bytes = small_vdag_file();
  const auto count_error = [](const std::string& changed) {
    return voxdag::error_of([&] {
      const AlignedBytes aligned(changed);
      count_svdag(parse_vdag(aligned.span()).view);
    });
  };
  EXPECT_GT(survive_bit_flips(bytes, count_error), 4 * static_cast<int>(bytes.size()));
}

TEST(VdagCorruption, TrailingBytesAreRefused) {
  EXPECT_EQ(vdag_error_of(small_vdag_file() + "x"),
            "byte " + std::to_string(small_vdag_file().size()) + ": has 1 trailing bytes");
  std::string bytes = small_vdag_file() + std::string(64, '\0');
  poke(bytes, offsetof(VdagHeader, file_bytes), std::uint64_t{bytes.size()});
  repair_checksums(bytes);
  EXPECT_EQ(vdag_error_of(bytes),
            "byte " + std::to_string(bytes.size() - 64) + ": has bytes after the last chunk");
}

TEST(VdagCorruption, OtherVersionsAreRefusedByName) {
  EXPECT_EQ(vdag_error_of(repaired_with(8, std::uint32_t{7})),
            "header: version 7 is newer than this program's version 1");
  EXPECT_EQ(vdag_error_of(repaired_with(8, std::uint32_t{0})), "header: version 0 does not exist");
}

TEST(VdagCorruption, DamageIsNamedByItsPlace) {
  std::string bytes = small_vdag_file();
  bytes[chunk_offset(bytes, 2)] ^= 1;
  EXPECT_EQ(vdag_error_of(bytes), "chunk NODE: checksum is wrong");
  bytes = small_vdag_file();
  bytes[entry_offset(1) + 9] ^= 1;
  EXPECT_EQ(vdag_error_of(bytes), "header: checksum of the header and chunk table is wrong");
  bytes = small_vdag_file();
  bytes.back() ^= 1;
  EXPECT_EQ(vdag_error_of(bytes),
            "byte " + std::to_string(bytes.size() - 1) + ": padding is not zero");
  bytes = small_vdag_file();
  EXPECT_EQ(vdag_error_of(bytes.substr(0, bytes.size() - 1)),
            "byte " + std::to_string(bytes.size() - 1) + ": truncated: the header says " +
                std::to_string(bytes.size()) + " bytes");
  EXPECT_EQ(vdag_error_of(bytes.substr(0, 20)),
            "byte 20: truncated: the file ends inside its header");
}

TEST(VdagCorruption, AbsurdSizesWithRightChecksumsAreRefused) {
  EXPECT_EQ(vdag_error_of(repaired_with(12, std::uint32_t{0xFFFFFFFF})),
            "header: 4294967295 chunks do not fit into the file");
  const std::size_t length = entry_offset(2) + offsetof(VdagChunkEntry, length);
  for (const std::uint64_t value :
       {~std::uint64_t{0}, ~std::uint64_t{63}, std::uint64_t{1} << 63, std::uint64_t{100000}})
    EXPECT_EQ(vdag_error_of(repaired_with(length, value)),
              "chunk table, chunk NODE: extends past the end of the file");
}

TEST(VdagCorruption, ChunksMustBeInOrderWithoutGapsOrOverlap) {
  const std::size_t offset = entry_offset(2) + offsetof(VdagChunkEntry, offset);
  const auto right = peek<std::uint64_t>(small_vdag_file(), offset);
  for (const std::uint64_t wrong : {right + 64, right - 64, right + 8, std::uint64_t{0}})
    EXPECT_EQ(vdag_error_of(repaired_with(offset, wrong)),
              "chunk table, chunk NODE: starts at byte " + std::to_string(wrong) +
                  ", expected byte " + std::to_string(right));
}

TEST(VdagCorruption, DuplicateAndMissingChunksAreRefused) {
  EXPECT_EQ(vdag_error_of(repaired_with(entry_offset(3), kChunkNodes)),
            "chunk table, chunk NODE: duplicate chunk");
  std::string bytes = repaired_with(entry_offset(3), vdag_chunk_id("ATTR"));
  EXPECT_EQ(
      vdag_error_of(bytes),
      "chunk table, chunk ATTR: unknown required chunk: this file needs a newer version of voxdag");
  poke(bytes, entry_offset(3) + 4, std::uint32_t{0});
  repair_checksums(bytes);
  EXPECT_EQ(vdag_error_of(bytes), "chunk table: chunk LEAF is missing");
}

TEST(VdagCorruption, AnUnknownChunkThatIsNotRequiredIsSkipped) {
  // Header and four entries end on a multiple of 64: the fifth needs another 64 bytes of table.
  std::string bytes = small_vdag_file();
  ASSERT_EQ(chunk_offset(bytes, 0), entry_offset(4));
  bytes.insert(entry_offset(4), std::string(64, '\0'));
  for (std::size_t i = 0; i < 4; ++i)
    poke(bytes, entry_offset(i) + 8, peek<std::uint64_t>(bytes, entry_offset(i) + 8) + 64);
  poke(bytes, entry_offset(4), VdagChunkEntry{vdag_chunk_id("xyzw"), 0, bytes.size(), 3, 0});
  bytes += "abc" + std::string(61, '\0');
  poke(bytes, offsetof(VdagHeader, chunk_count), std::uint32_t{5});
  poke(bytes, offsetof(VdagHeader, file_bytes), std::uint64_t{bytes.size()});
  repair_checksums(bytes);
  EXPECT_EQ(vdag_error_of(bytes), "no error");
  bytes[bytes.size() - 64] = 'x';
  EXPECT_EQ(vdag_error_of(bytes), "chunk xyzw: checksum is wrong");
}

TEST(VdagCorruption, FaultsInTheDagAreNamed) {
  const std::string bytes = small_vdag_file();
  EXPECT_EQ(vdag_error_of(repaired_with(chunk_offset(bytes, 2) + 4, std::uint32_t{100})),
            "chunk NODE, level 0, word 1: pointer points outside the next level");
  EXPECT_EQ(vdag_error_of(repaired_with(chunk_offset(bytes, 3), std::uint64_t{0})),
            "chunk LEAF, leaf block 0: leaf block has no voxels");
  EXPECT_EQ(vdag_error_of(repaired_with(chunk_offset(bytes, 1), std::uint64_t{1})),
            "chunk LEVL, level table: level 0 does not begin at word 0");
  EXPECT_EQ(vdag_error_of(repaired_with(chunk_offset(bytes, 1) + 16, std::uint64_t{6})),
            "chunk NODE: has 7 words, but the level table says 6");
  EXPECT_EQ(vdag_error_of(repaired_with(chunk_offset(bytes, 0), '[')),
            "chunk META, byte 8: not valid JSON");
  EXPECT_EQ(vdag_error_of(repaired_with(chunk_offset(bytes, 0), std::array{'{', '}', '\0'})),
            "chunk META, byte 3: not valid JSON");
}

}  // namespace
}  // namespace voxdag
