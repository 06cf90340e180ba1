#include "voxdag/file/esvo_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/error_of.hpp"
#include "support/esvo_bytes.hpp"
#include "support/temp_dir.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/file/verify_vdag.hpp"

namespace voxdag {
namespace {

using test::packed_esvo;
using test::PackedEsvo;

std::string esvo_error_of(const std::string& bytes) {
  return voxdag::error_of([&] { parse_esvo(AlignedBytes(bytes).span()); });
}

std::string small_esvo_file() {
  const TempDir dir;
  write_esvo(dir / "a.esvo", packed_esvo(3, 64, 5));
  return read_text(dir / "a.esvo");
}

TEST(EsvoFile, HoldsWhatWasWritten) {
  const TempDir dir;
  const PackedEsvo esvo = packed_esvo(6, 200, 1);
  write_esvo(dir / "a.esvo", esvo);
  const EsvoFile file(dir / "a.esvo");
  EXPECT_EQ(file.metadata(), metadata_of(esvo));
  ASSERT_EQ(file.view().slot_count, esvo.packed.slots.size());
  EXPECT_TRUE(std::equal(esvo.packed.slots.begin(), esvo.packed.slots.end(), file.view().slots));
  ASSERT_EQ(file.directory().size(), esvo.packed.blocks.size());
  EXPECT_GT(file.directory().size(), 5u);
  for (std::size_t i = 0; i < file.directory().size(); ++i) {
    EsvoBlockEntry entry = file.directory()[i];
    entry.checksum = 0;
    EXPECT_EQ(entry, esvo.packed.blocks[i]);
  }
  EXPECT_EQ(vdag_kind(dir / "a.esvo"), VdagKind::kEsvo);
  EXPECT_TRUE(verify_vdag(dir / "a.esvo").passed());
  EXPECT_EQ(dir.count(), 1) << "no temporary file is left";
}

TEST(EsvoFile, AWriterThatIsNotFinishedLeavesNothing) {
  const TempDir dir;
  {
    EsvoFileWriter writer(dir / "a.esvo");
    writer.append(packed_esvo(3, 64, 5).packed.slots);
  }
  EXPECT_EQ(dir.count(), 0);
}

TEST(EsvoFile, DagsAndEsvosAreDistinguished) {
  const TempDir dir;
  write_esvo(dir / "a.esvo", packed_esvo(3, 64, 5));
  EXPECT_THROW(VdagFile(dir / "a.esvo"), Error);
  write_text(dir / "b.vdag", vdag_file_bytes(brute_svdag(4, {{0, 0, 0}})));
  EXPECT_EQ(vdag_kind(dir / "b.vdag"), VdagKind::kPlain);
  EXPECT_THROW(EsvoFile(dir / "b.vdag"), Error);
}

TEST(EsvoFile, EveryTruncationIsRefused) {
  const std::string bytes = small_esvo_file();
  for (std::size_t size = 0; size < bytes.size(); size += size < 512 ? 1 : 61)
    EXPECT_NE(esvo_error_of(bytes.substr(0, size)), "no error") << size << " bytes";
}

TEST(EsvoFile, EveryBitFlipIsRefused) {
  const std::string bytes = small_esvo_file();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += bit < 8 * 512 ? 1 : 13) {
    std::string changed = bytes;
    changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ 1 << bit % 8);
    EXPECT_NE(esvo_error_of(changed), "no error") << "byte " << bit / 8;
  }
}

TEST(EsvoFile, DoesNotChangeWhenTheFileIsRewrittenInPlace) {
  const TempDir dir;
  const PackedEsvo esvo = packed_esvo(5, 200, 1);
  write_esvo(dir / "a.esvo", esvo);
  const EsvoFile file(dir / "a.esvo");
  const auto size = std::filesystem::file_size(dir / "a.esvo");
  std::fstream(dir / "a.esvo") << std::string(size, '\xFF');
  EXPECT_TRUE(std::equal(esvo.packed.slots.begin(), esvo.packed.slots.end(), file.view().slots));
}

}  // namespace
}  // namespace voxdag
