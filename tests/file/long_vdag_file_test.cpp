#include "voxdag/file/long_vdag_file.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/long_form.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/file/verify_vdag.hpp"

namespace voxdag {
namespace {

class LongVdagFileTest : public testing::Test {
 protected:
  const Svdag dag_ = brute_svdag(6, random_voxels(6, 3000, 4));
  const std::string bytes_ = long_vdag_bytes(dag_);
  const TempDir folder_;
  const std::filesystem::path path_ = folder_ / "long.vdag";
};

TEST_F(LongVdagFileTest, IsReadAndVerified) {
  write_text(path_, bytes_);
  EXPECT_EQ(vdag_kind(path_), VdagKind::kLong);
  const LongVdagFile file(path_);
  EXPECT_EQ(count_svdag(file.view()), count_svdag(dag_.view()));
  EXPECT_EQ(file.metadata().counts, count_svdag(dag_.view()));
  EXPECT_TRUE(verify_vdag(path_).passed());
}

TEST_F(LongVdagFileTest, ReadersOfThePlainFormNameTheWayOut) {
  write_text(path_, bytes_);
  EXPECT_EQ(
      error_of([&] { VdagFile file(path_); }),
      path_.string() +
          ": has long pointers (more than 2^32 node words), but a plain DAG is needed: voxdag "
          "crop and voxdag coarsen make one");
}

TEST_F(LongVdagFileTest, OtherFilesHaveNoLongPointers) {
  write_text(path_, vdag_file_bytes(dag_));
  EXPECT_EQ(vdag_kind(path_), VdagKind::kPlain);
  EXPECT_TRUE(VdagContainer(path_).is(VdagKind::kPlain));
  write_text(path_, "");
  EXPECT_THROW(vdag_kind(path_), Error);
  EXPECT_FALSE(VdagContainer(path_).is(VdagKind::kLong));
}

TEST_F(LongVdagFileTest, AnyFlippedBitAndAnyTruncationIsRefused) {
  for (std::size_t at = 0; at < bytes_.size(); at += 37) {
    std::string damaged = bytes_;
    damaged[at] ^= static_cast<char>(1 << at % 8);
    write_text(path_, damaged);
    EXPECT_THROW(LongVdagFile file(path_), Error) << at;
    EXPECT_FALSE(verify_vdag(path_).passed()) << at;
    write_text(path_, bytes_.substr(0, at));
    EXPECT_THROW(LongVdagFile file(path_), Error) << at;
  }
}

TEST_F(LongVdagFileTest, WordsWithRightChecksumsAreSafeOrRefused) {
  const auto nodes = peek<VdagChunkEntry>(bytes_, entry_offset(2));
  for (std::uint64_t bit = 0; bit < nodes.length * 8; bit += 13) {
    std::string changed = bytes_;
    changed[nodes.offset + bit / 8] ^= static_cast<char>(1 << bit % 8);
    repair_checksums(changed);
    write_text(path_, changed);
    try {
      const LongVdagFile file(path_);
      EXPECT_GT(count_svdag(file.view()).voxels, 0u);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("NODX"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace voxdag
