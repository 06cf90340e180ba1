#include "voxdag/cluster/shared_file.hpp"

#include <gtest/gtest.h>

#include <array>

#include "ranks_under_test.hpp"
#include "shared_folder.hpp"
#include "support/error_of.hpp"

namespace voxdag {
namespace {

/// Longer than a message, so that ranks write it in parts.
constexpr std::uint64_t kPart = 5 * kMessageBytes / 2;

std::vector<std::byte> part_of(int rank) {
  return std::vector<std::byte>(kPart, static_cast<std::byte>('a' + rank));
}

TEST(SharedFile, EveryRankWritesItsPart) {
  const SharedFolder folder(ranks());
  const auto path = folder / "out";
  const std::uint64_t count = ranks().count(), gap = 7;
  SharedFile file(ranks(), path, count * kPart + gap);
  file.write_at(ranks().rank() * kPart, part_of(ranks().rank()));
  EXPECT_FALSE(std::filesystem::exists(path));
  ranks().barrier();
  file.commit();
  std::string expected;
  for (std::uint64_t rank = 0; rank < count; ++rank)
    expected.append(kPart, static_cast<char>('a' + rank));
  expected.append(gap, '\0');
  EXPECT_EQ(read_text(path), expected);
  EXPECT_EQ(folder.count(), 1);
}

TEST(SharedFile, AnOlderFileStaysUnlessItIsReplaced) {
  const SharedFolder folder(ranks());
  const auto path = folder / "out";
  if (ranks().rank() == 0) write_text(path, "older");
  ranks().barrier();
  {
    SharedFile file(ranks(), path, 3);
    ranks().barrier();
    EXPECT_EQ(folder.count(), 2);
    ranks().barrier();
  }
  ranks().barrier();
  EXPECT_EQ(read_text(path), "older");
  EXPECT_EQ(folder.count(), 1);
  ranks().barrier();
  SharedFile(ranks(), path, 3).commit();
  EXPECT_EQ(read_text(path), std::string(3, '\0'));
}

TEST(SharedFile, AFolderThatDoesNotExistIsAnErrorOnEveryRank) {
  const SharedFolder folder(ranks());
  const auto path = folder / "none/out";
  const std::string error = error_of([&] { SharedFile(ranks(), path, 3); });
  const std::string prefix = path.string() + ": cannot write: ";
  EXPECT_EQ(error, prefix + (ranks().rank() == 0 ? "No such file or directory" : "rank 0 failed"));
  EXPECT_NE(error_of([&] { SharedFile(ranks(), "/dev/null", 3); }).find("/dev/null: "),
            std::string::npos);
}

TEST(SharedFile, AFileThatDoesNotExistCannotBeOpened) {
  const SharedFolder folder(ranks());
  const auto path = folder / "none";
  const std::string error = error_of([&] { ranks().open_file(path); });
  EXPECT_EQ(error.find(path.string() + ": byte 0: cannot open: "), 0u) << error;
}

}  // namespace
}  // namespace voxdag
