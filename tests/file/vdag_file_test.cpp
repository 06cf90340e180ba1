#include "voxdag/file/vdag_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "support/error_of.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

Svdag owned(const SvdagView& view) {
  Svdag dag;
  dag.levels = view.levels;
  dag.nodes.assign(view.nodes, view.nodes + view.node_words());
  dag.leaf_blocks.assign(view.leaf_blocks, view.leaf_blocks + view.leaf_block_count);
  std::copy(std::begin(view.level_begin), std::end(view.level_begin), dag.level_begin.begin());
  return dag;
}

TEST(VdagFile, GivesBackWhatWasWritten) {
  const TempDir dir;
  for (int levels = 2; levels <= 8; ++levels)
    for (const int count : {0, 1, 200}) {
      const Svdag dag = brute_svdag(levels, random_voxels(levels, count, 7));
      const VdagMetadata metadata = example_metadata(dag.view());
      write_vdag(dir / "a.vdag", dag.view(), metadata);
      const VdagFile file(dir / "a.vdag");
      EXPECT_EQ(owned(file.view()), dag);
      EXPECT_EQ(file.metadata(), metadata);
      EXPECT_EQ(file.grid(), metadata.grid);
      EXPECT_EQ(file.file_bytes(), std::filesystem::file_size(dir / "a.vdag"));
    }
}

TEST(VdagFile, TheDeepestEmptyGridWorks) {
  const TempDir dir;
  const Svdag dag = brute_svdag(kMaxLevels, {});
  write_vdag(dir / "a.vdag", dag.view(), example_metadata(dag.view()));
  EXPECT_TRUE(VdagFile(dir / "a.vdag").view().is_empty());
}

TEST(VdagFile, TheDeepestGridWorks) {
  const TempDir dir;
  const Svdag dag = brute_svdag(kMaxLevels, {{0, 0, 0}, {1048575, 524288, 1}});
  write_vdag(dir / "a.vdag", dag.view(), example_metadata(dag.view()));
  EXPECT_EQ(owned(VdagFile(dir / "a.vdag").view()), dag);
}

TEST(VdagFile, EqualInputsMakeEqualBytes) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 100, 1));
  EXPECT_EQ(vdag_file_bytes(dag), vdag_file_bytes(dag));
}

TEST(VdagFile, ChunksAreAlignedTo64Bytes) {
  const TempDir dir;
  const Svdag dag = brute_svdag(6, random_voxels(6, 100, 1));
  write_vdag(dir / "a.vdag", dag.view(), example_metadata(dag.view()));
  const VdagFile file(dir / "a.vdag");
  ASSERT_EQ(file.chunks().size(), 4u);
  for (const VdagChunk& chunk : file.chunks()) EXPECT_EQ(chunk.offset % 64, 0u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(file.view().nodes) % 64, 0u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(file.view().leaf_blocks) % 64, 0u);
}

TEST(VdagFile, ViewsOutliveAMove) {
  const TempDir dir;
  const Svdag dag = brute_svdag(6, random_voxels(6, 100, 1));
  write_vdag(dir / "a.vdag", dag.view(), example_metadata(dag.view()));
  VdagFile first(dir / "a.vdag");
  const SvdagView view = first.view();
  const VdagFile second(std::move(first));
  EXPECT_EQ(owned(view), dag);
  EXPECT_EQ(second.view().nodes, view.nodes);
}

TEST(VdagFile, AnOpenFileMayBeReplaced) {
  const TempDir dir;
  const Svdag old_dag = brute_svdag(6, random_voxels(6, 100, 1)), new_dag = brute_svdag(3, {});
  write_vdag(dir / "a.vdag", old_dag.view(), example_metadata(old_dag.view()));
  const VdagFile file(dir / "a.vdag");
  write_vdag(dir / "a.vdag", new_dag.view(), example_metadata(new_dag.view()));
  EXPECT_EQ(owned(file.view()), old_dag);
  EXPECT_EQ(owned(VdagFile(dir / "a.vdag").view()), new_dag);
}

TEST(VdagFile, OtherThingsThanFilesAreRefused) {
  const TempDir dir;
  EXPECT_EQ(error_of([&] { VdagFile file(dir / "none"); }),
            (dir / "none").string() + ": cannot open: No such file or directory");
  EXPECT_EQ(error_of([&] { VdagFile file(dir.path()); }), dir.path().string() + ": is a directory");
  ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(error_of([&] { VdagFile file(dir / "pipe"); }),
            (dir / "pipe").string() + ": is not a regular file");
  write_text(dir / "empty", "");
  EXPECT_EQ(error_of([&] { VdagFile file(dir / "empty"); }),
            (dir / "empty").string() + ": empty file");
  write_text(dir / "text", "v 0 0 0\n");
  EXPECT_EQ(error_of([&] { VdagFile file(dir / "text"); }),
            (dir / "text").string() + ": header: not a .vdag file");
}

TEST(VdagFile, AFullDiskIsAnErrorWithTheByte) {
  const Svdag dag = brute_svdag(3, {{1, 2, 3}});
  EXPECT_EQ(error_of([&] { write_vdag("/dev/full", dag.view(), example_metadata(dag.view())); }),
            "/dev/full: byte 0: cannot write: No space left on device");
}

TEST(VdagFile, AGridThatNoFileMayHoldIsRefusedByTheWriter) {
  const TempDir dir;
  const Svdag dag = brute_svdag(3, {{1, 2, 3}});
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.grid.voxel_size = 0;
  EXPECT_EQ(error_of([&] { write_vdag(dir / "a", dag.view(), metadata); }),
            (dir / "a").string() + ": grid.voxel_size: not positive");
  EXPECT_EQ(dir.count(), 0);
}

TEST(VdagFile, DoesNotChangeWhenTheFileIsRewrittenInPlace) {
  const TempDir dir;
  const Svdag dag = brute_svdag(6, random_voxels(6, 300, 7));
  write_vdag(dir / "a.vdag", dag.view(), example_metadata(dag.view()));
  const VdagFile file(dir / "a.vdag");
  const auto size = std::filesystem::file_size(dir / "a.vdag");
  std::fstream(dir / "a.vdag") << std::string(size, '\xFF');
  EXPECT_EQ(owned(file.view()), dag);
  std::filesystem::resize_file(dir / "a.vdag", 0);
  EXPECT_EQ(owned(file.view()), dag);
}

}  // namespace
}  // namespace voxdag
