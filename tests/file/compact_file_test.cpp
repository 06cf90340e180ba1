// Tests files of compact DAGs: what was written comes back, and damage is refused or harmless.
#include "voxdag/file/compact_file.hpp"

#include <gtest/gtest.h>

#include "support/damaged_bytes.hpp"
#include "support/error_of.hpp"
#include "support/number_colors.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"

namespace voxdag {
namespace {

std::string compact_file_bytes(const Svdag& dag) {
  const TempDir dir;
  write_vdag(dir / "file.vdag", encode_svdag(dag.view()), example_metadata(dag.view()));
  return read_text(dir / "file.vdag");
}

std::string small_file() { return compact_file_bytes(brute_svdag(6, random_voxels(6, 40, 3))); }

/// Returns a file with colours and normals of the cells down to level `finest`.
std::string colored_compact_file(int finest) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 40, 3));
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.attributes.resolution = std::int64_t{1} << finest;
  metadata.attributes.colors = {0.25, 1234};
  metadata.attributes.normals = {3.5, 99};
  metadata.attributes.materials.emplace(kNumberMaterials, "name");
  const TempDir dir;
  const NumberColors colors(dag.view(), finest);
  write_vdag(dir / "file.vdag", encode_svdag(dag.view()), metadata, colors.view().attributes);
  return read_text(dir / "file.vdag");
}

/// Decodes the file and reads the attributes of all its cells.
void read_all(const std::string& bytes) {
  const AlignedBytes aligned(bytes);
  const CompactContents contents = parse_compact(aligned.span());
  const Svdag dag = decode_svdag(contents.view());
  if (!contents.has_attributes()) return;
  const CellIndex index = build_cell_index(dag.view(), contents.metadata.attributes.level());
  ExpandedChunks expanded;
  const DagAttributesView attributes = contents.attributes(index.view(), expanded);
  for (std::uint64_t i = 0; i < index.cells; ++i) {
    if (attributes.has_colors()) read_value(attributes.colors, i);
    if (attributes.has_normals()) read_value(attributes.normals, i);
    if (attributes.has_materials()) read_material(attributes.materials, i);
  }
}

std::string decode_error(const std::string& bytes) {
  return error_of([&] { read_all(bytes); });
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
      EXPECT_EQ(vdag_kind(dir / "a.vdag"), VdagKind::kCompact);
    }
}

TEST(CompactFile, TheAttributesOfAllCellsAreThoseThatWereWritten) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 40, 3));
  for (int finest = 0; finest <= 6; ++finest) {
    const AlignedBytes bytes(colored_compact_file(finest));
    const CompactContents contents = parse_compact(bytes.span());
    EXPECT_FALSE(has_chunk(contents.chunks, kChunkCellIndex));
    const CellIndex index = build_cell_index(dag.view(), contents.metadata.attributes.level());
    ExpandedChunks expanded;
    const DagAttributesView attributes = contents.attributes(index.view(), expanded);
    for (std::uint64_t i = 0; i < index.cells; ++i) {
      ASSERT_EQ(read_value(attributes.colors, i), color_of_number(i));
      ASSERT_EQ(read_value(attributes.normals, i), color_of_number(i));
      ASSERT_EQ(read_material(attributes.materials, i), material_of_number(i));
    }
  }
}

TEST(CompactFile, ColoursOfAnotherNumberOfCellsAreRefused) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 40, 3));
  const AlignedBytes bytes(colored_compact_file(6));
  const CompactContents contents = parse_compact(bytes.span());
  const CellIndex coarser = build_cell_index(dag.view(), 5);
  ExpandedChunks expanded;
  const std::string error = error_of([&] { contents.attributes(coarser.view(), expanded); });
  EXPECT_NE(error.find("chunk COLR: has "), std::string::npos) << error;
}

TEST(CompactFile, ColoursThatTheMetadataDoesNotDescribeAreNotWritten) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 40, 3));
  const NumberColors colors(dag.view(), 6);
  const TempDir dir;
  const std::string error = error_of([&] {
    write_vdag(dir / "a.vdag", encode_svdag(dag.view()), example_metadata(dag.view()),
               colors.view().attributes);
  });
  EXPECT_NE(error.find("attributes: is missing"), std::string::npos) << error;
  EXPECT_EQ(dir.count(), 0);
}

TEST(CompactFile, NumbersOfCellsAreRefused) {
  std::string bytes = colored_compact_file(6);
  auto entry = peek<VdagChunkEntry>(bytes, entry_offset(3));
  entry.id = kChunkCellIndex;
  poke(bytes, entry_offset(3), entry);
  repair_checksums(bytes);
  const std::string error = decode_error(bytes);
  EXPECT_NE(error.find("chunk CIDX: belongs to the plain form"), std::string::npos) << error;
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
  EXPECT_EQ(vdag_kind(dir / "b.vdag"), VdagKind::kPlain);
  EXPECT_EQ(error_of([&] { CompactFile(dir / "b.vdag"); }),
            (dir / "b.vdag").string() + ": does not hold a compact DAG");
}

TEST(CompactFile, EveryTruncationIsRefused) {
  expect_truncations_are_refused(small_file(), decode_error);
  expect_truncations_are_refused(colored_compact_file(5), decode_error);
}

TEST(CompactFile, EveryBitFlipIsRefused) {
  expect_bit_flips_are_refused(small_file(), decode_error);
  expect_bit_flips_are_refused(colored_compact_file(5), decode_error);
}

TEST(CompactFile, EveryBitFlipWithRightChecksumsIsSurvived) {
  survive_bit_flips(small_file(), decode_error);
  survive_bit_flips(colored_compact_file(5), decode_error);
}

}  // namespace
}  // namespace voxdag
