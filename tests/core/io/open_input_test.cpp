#include "voxdag/core/io/open_input.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"

namespace voxdag {
namespace {

constexpr SizeLimit kSmall{1 << 20, "a camera path"};

TEST(ReadInput, ReturnsEveryByteOfAFileUpToTheLimit) {
  const TempDir dir;
  for (const std::size_t size : {0, 1, 4096, (1 << 20) - 1, 1 << 20}) {
    const std::string text(size, 'x');
    write_text(dir / "in", text);
    EXPECT_EQ(read_input(dir / "in", kSmall), text);
  }
}

TEST(ReadInput, RefusesALargerFileByItsSize) {
  const TempDir dir;
  write_text(dir / "in", "");
  std::filesystem::resize_file(dir / "in", std::uintmax_t{3} << 30);
  EXPECT_EQ(reason_of([&] { read_input(dir / "in", kSmall); }),
            "3221225472 bytes are more than the limit of 1 MiB for a camera path");
}

TEST(ReadInput, ReadsAPipeUpToTheLimit) {
  const TempDir dir;
  ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
  for (const std::size_t size : {3, 300000, 1 << 20, (1 << 20) + 1}) {
    std::thread writer([&] { write_text(dir / "pipe", std::string(size, 'x')); });
    std::string text;
    const std::string reason =
        reason_of([&] { text = read_input(dir / "pipe", kSmall, InputKind::kFileOrPipe); });
    writer.join();
    if (size <= kSmall.bytes)
      EXPECT_EQ(text.size(), size);
    else
      EXPECT_EQ(reason, "its content is more than the limit of 1 MiB for a camera path");
  }
}

TEST(ReadInput, RefusesDevicesOfEndlessBytes) {
  EXPECT_EQ(reason_of([] { read_input("/dev/zero", kSmall); }), "is not a regular file");
  EXPECT_EQ(reason_of([] { read_input("/dev/zero", kSmall, InputKind::kFileOrPipe); }),
            "is neither a regular file nor a pipe");
}

/// All functions that open an input report faults with the same text.
TEST(OpenInput, FaultsHaveTheSameTextHoweverAFileIsOpened) {
  const TempDir dir;
  ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
  write_text(dir / "large", std::string(2000, 'x'));
  const SizeLimit limit{1000, "an image"};
  const std::function<void(const std::filesystem::path&)> ways[] = {
      [&](const auto& path) { open_input(path, InputKind::kRegularFile, limit); },
      [&](const auto& path) { read_input(path, limit); },
      [&](const auto& path) { MappedFile(path, MappedFile::Access::kSoon, limit); }};
  for (const auto& open : ways) {
    EXPECT_EQ(reason_of([&] { open(dir / "none"); }), "cannot open: No such file or directory");
    EXPECT_EQ(reason_of([&] { open(dir.path()); }), "is a directory");
    EXPECT_EQ(reason_of([&] { open(dir / "pipe"); }), "is not a regular file");
    EXPECT_EQ(reason_of([&] { open(dir / "large"); }),
              "2000 bytes are more than the limit of 1000 bytes for an image");
  }
}

TEST(MappedFile, ReadsReleasedPagesAgain) {
  const TempDir dir;
  std::string text;
  for (int i = 0; i < 30000; ++i) text += std::to_string(i);
  write_text(dir / "in", text);
  const MappedFile file(dir / "in", MappedFile::Access::kSequential);
  EXPECT_EQ(file.text(), text);
  file.release(file.text().substr(5, 100000));
  EXPECT_EQ(file.text(), text);
}

TEST(MappedFile, KeepsItsBytesWhenMoved) {
  const TempDir dir;
  write_text(dir / "in", "text");
  MappedFile first(dir / "in");
  const std::byte* const address = first.bytes().data();
  const MappedFile second(std::move(first));
  EXPECT_EQ(second.text(), "text");
  EXPECT_EQ(second.bytes().data(), address);
}

TEST(MappedFile, OfAnEmptyFileIsEmpty) {
  const TempDir dir;
  write_text(dir / "in", "");
  const MappedFile file(dir / "in");
  EXPECT_TRUE(file.bytes().empty());
  file.release(file.text());
}

}  // namespace
}  // namespace voxdag
