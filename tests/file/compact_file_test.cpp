// Tests files of compact DAGs: what was written comes back, and damage is refused or harmless.
#include "voxdag/file/compact_file.hpp"

#include <gtest/gtest.h>

#include "support/damaged_bytes.hpp"
#include "support/error_of.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/compact/encode_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/scene_file.hpp"

namespace voxdag {
namespace {

std::string compact_file_bytes(const Svdag& dag) {
  const TempDir dir;
  write_vdag(dir / "file.vdag", encode_svdag(dag.view()), example_metadata(dag.view()));
  return read_text(dir / "file.vdag");
}

std::string small_file() { return compact_file_bytes(brute_svdag(6, random_voxels(6, 40, 3))); }

std::string decode_error(const std::string& bytes) {
  return error_of([&] {
    const AlignedBytes aligned(bytes);
    decode_svdag(parse_compact(aligned.span()).view());
  });
}

TEST(CompactFile, GivesBackWhatWasWritten) {
  const TempDir dir;
  for (int levels = 2; levels <= 8; ++levels)
    for (const int count : {0, 1, 200}) {
      const Svdag dag = brute_svdag(levels, random_voxels(levels, count, 7));
      const VdagMetadata metadata = example_metadata(dag.view());
      write_vdag(dir / "a.vdag", encode_svdag(dag.view()), metadata);
      CompactFile first(dir / "a.vdag");
      const CompactFile file(std::move(first));
      EXPECT_EQ(decode_svdag(file.view()), dag);
      EXPECT_EQ(file.metadata(), metadata);
      EXPECT_EQ(file.file_bytes(), std::filesystem::file_size(dir / "a.vdag"));
      EXPECT_TRUE(is_compact_file(dir / "a.vdag"));
    }
}

TEST(CompactFile, IsNotReadAsAPlainDag) {
  const TempDir dir;
  write_text(dir / "a.vdag", small_file());
  EXPECT_EQ(
      error_of([&] { VdagFile(dir / "a.vdag"); }),
      (dir / "a.vdag").string() +
          ": holds a compact DAG, but one in the plain form is needed: voxdag convert --plain");
  const Svdag dag = brute_svdag(4, {});
  write_vdag(dir / "b.vdag", dag.view(), example_metadata(dag.view()));
  EXPECT_FALSE(is_compact_file(dir / "b.vdag"));
  EXPECT_EQ(error_of([&] { CompactFile(dir / "b.vdag"); }),
            (dir / "b.vdag").string() + ": does not hold a compact DAG");
}

TEST(CompactFile, EveryTruncationIsRefused) {
  expect_truncations_are_refused(small_file(), decode_error);
}

TEST(CompactFile, EveryBitFlipIsRefused) {
  expect_bit_flips_are_refused(small_file(), decode_error);
}

TEST(CompactFile, EveryBitFlipWithRightChecksumsIsSurvived) {
  survive_bit_flips(small_file(), decode_error);
}

}  // namespace
}  // namespace voxdag
