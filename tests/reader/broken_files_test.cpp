// Tests include/voxdag.h with damaged files: it refuses what the library refuses, reads what it
// reads, and touches no byte outside of the file.
#include <gtest/gtest.h>

#include "reader/header_scene.hpp"
#include "support/damaged_bytes.hpp"
#include "support/esvo_bytes.hpp"
#include "support/long_form.hpp"
#include "support/number_colors.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"

namespace voxdag {
namespace {

std::string plain_bytes(int levels = 4) {
  const std::int32_t last = (1 << levels) - 1;
  return vdag_file_bytes(brute_svdag(levels, {{0, 0, 0}, {last, last, last}}));
}

std::string colored_bytes(int finest, AttributeForm form = AttributeForm::kPages) {
  const Svdag dag = brute_svdag(5, random_voxels(5, 60, 2));
  const NumberColors colors(dag.view(), finest);
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.attributes.resolution = std::int64_t{1} << finest;
  const TempDir dir;
  write_vdag(dir / "file.vdag", dag.view(), metadata, colors.view().attributes, form);
  return read_text(dir / "file.vdag");
}

std::string chunk_of(const std::string& bytes, std::uint32_t id) {
  const VdagChunkEntry entry = find_entry(bytes, id);
  return bytes.substr(entry.offset, entry.length);
}

TEST(ReaderBrokenFiles, EveryTruncationIsRefused) {
  for (const std::string& whole : {plain_bytes(), plain_bytes(2), colored_bytes(5)})
    for (std::size_t size = 0; size < whole.size(); ++size) {
      std::string bytes = whole.substr(0, size);
      EXPECT_FALSE(HeaderScene(bytes).is_open());
      ASSERT_EQ(disagreement(bytes, 100), "") << size;
      if (size < sizeof(VdagHeader)) continue;
      poke(bytes, offsetof(VdagHeader, file_bytes), std::uint64_t{size});
      repair_checksums(bytes);
      ASSERT_EQ(disagreement(bytes, 100), "") << size << " bytes, and the header agrees";
    }
}

TEST(ReaderBrokenFiles, EveryFlippedBitIsRefused) {
  for (const std::string& bytes : {plain_bytes(), plain_bytes(2), colored_bytes(5)})
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit)
      ASSERT_FALSE(HeaderScene(with_flipped_bit(bytes, bit)).is_open()) << "bit " << bit;
}

/// Flips each bit with a number that is a multiple of `step`, and corrects the checksums, which may
/// make another valid file.
void expect_equal_reading_of_flips(const std::string& bytes, std::size_t step) {
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += step) {
    std::string changed = with_flipped_bit(bytes, bit);
    repair_checksums(changed);
    ASSERT_EQ(disagreement(changed, 10), "") << "bit " << bit;
  }
}

TEST(ReaderBrokenFiles, FlippedBitsWithRightChecksumsAreReadAsTheLibraryReadsThem) {
  for (const int levels : {2, 3, 4}) expect_equal_reading_of_flips(plain_bytes(levels), 1);
  for (const int finest : {2, 4, 5}) expect_equal_reading_of_flips(colored_bytes(finest), 11);
  expect_equal_reading_of_flips(colored_bytes(5, AttributeForm::kWire), 11);
}

TEST(ReaderBrokenFilesExtended, EveryFlippedBitWithRightChecksumsIsReadAsTheLibraryReadsIt) {
  for (const int finest : {2, 4, 5}) expect_equal_reading_of_flips(colored_bytes(finest), 1);
  expect_equal_reading_of_flips(colored_bytes(5, AttributeForm::kWire), 1);
}

TEST(ReaderBrokenFiles, ChunksOfEveryLengthAreReadAsTheLibraryReadsThem) {
  const std::string bytes = colored_bytes(5);
  for (const std::uint32_t id : {kChunkLevels, kChunkNodes, kChunkLeafBlocks, kChunkCellIndex,
                                 kChunkColors, kChunkNormals, kChunkMaterials}) {
    const std::string chunk = chunk_of(bytes, id);
    for (std::size_t size = 0; size < chunk.size(); ++size)
      ASSERT_EQ(disagreement(with_chunk(bytes, id, chunk.substr(0, size)), 10), "");
    for (std::size_t more = 1; more <= 72; ++more)
      ASSERT_EQ(disagreement(with_chunk(bytes, id, chunk + std::string(more, '\0')), 10), "");
  }
}

TEST(ReaderBrokenFiles, ChunksThatAreMissingOrUnknownAreReadAsTheLibraryReadsThem) {
  const std::string bytes = colored_bytes(5);
  for (std::size_t i = 0; i < peek<VdagHeader>(bytes, 0).chunk_count; ++i)
    for (const std::uint32_t id :
         {vdag_chunk_id("abcd"), kChunkNodes, kChunkLongNodes, kChunkEsvo, kChunkCompactHead,
          kChunkCompactStream, kChunkWireColors, kChunkColors})
      for (const std::uint32_t flags : {0u, 1u, 2u}) {
        std::string changed = bytes;
        poke(changed, entry_offset(i), id);
        poke(changed, entry_offset(i) + 4, flags);
        repair_checksums(changed);
        ASSERT_EQ(disagreement(changed, 10), "") << "chunk " << i << ", " << vdag_chunk_name(id);
      }
}

TEST(ReaderBrokenFiles, OtherKindsOfFilesAreRefusedByName) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 40, 3));
  const TempDir dir;
  write_vdag(dir / "compact.vdag", encode_svdag(dag.view()), example_metadata(dag.view()));
  EXPECT_EQ(HeaderScene(read_text(dir / "compact.vdag")).error(),
            "the DAG is in the compact form: `voxdag convert FILE --plain` makes the plain form");
  test::write_esvo(dir / "scene.esvo", test::packed_esvo(5, 200, 1));
  EXPECT_EQ(HeaderScene(read_text(dir / "scene.esvo")).error(),
            "the file holds an ESVO, not a DAG");
  EXPECT_EQ(HeaderScene(long_vdag_bytes(dag)).error(),
            "the DAG has long pointers: `voxdag crop` and `voxdag coarsen` make smaller ones");
  EXPECT_EQ(HeaderScene("solid cube").error(), "not a .vdag file");
}

TEST(ReaderBrokenFiles, AttributesInTheWireFormAreSkipped) {
  const HeaderScene header(colored_bytes(5, AttributeForm::kWire));
  ASSERT_TRUE(header.is_open()) << header.error();
  EXPECT_EQ(header.scene().info.has_wire_form, 1);
  EXPECT_EQ(header.scene().info.has_colors, 0);
  EXPECT_EQ(HeaderScene(colored_bytes(5)).scene().info.has_wire_form, 0);
}

TEST(ReaderBrokenFiles, TooLittleScratchMemoryIsRefused) {
  const std::string bytes = colored_bytes(5);
  voxdag_scene scene;
  char scratch = 0;
  EXPECT_STREQ(voxdag_open(&scene, bytes.data(), bytes.size(), &scratch, 1),
               "the scratch memory is too small");
}

TEST(ReaderBrokenFiles, TheByteOfAFaultIsNamed) {
  std::string bytes = plain_bytes();
  const VdagChunkEntry nodes = find_entry(bytes, kChunkNodes);
  poke(bytes, nodes.offset + 4, std::uint32_t{100});
  repair_checksums(bytes);
  const HeaderScene header(bytes);
  EXPECT_EQ(header.error(), "chunk NODE: pointer leads outside of the next level");
  EXPECT_EQ(header.scene().error_at, nodes.offset + 4);
}

}  // namespace
}  // namespace voxdag
