#include "voxdag/cluster/work_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kKey = 7;

std::string text_of(const WorkFile& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

std::string write(const std::filesystem::path& path, std::size_t bytes) {
  WorkFileWriter file(path, kKey, 100);
  std::string text;
  for (std::size_t i = 0; text.size() < bytes; ++i) {
    const std::string more = (std::to_string(i) + " ").substr(0, bytes - text.size());
    file.write(std::as_bytes(std::span<const char>(more)));
    text += more;
  }
  EXPECT_EQ(file.size(), bytes);
  EXPECT_FALSE(std::filesystem::exists(path));
  file.commit();
  return text;
}

TEST(WorkFile, IsReadAsItWasWritten) {
  const TempDir dir;
  for (const std::size_t bytes : {0, 1, 99, 100, 101, 5000}) {
    const std::string text = write(dir / "file", bytes);
    const auto file = WorkFile::open(dir / "file", kKey, {});
    ASSERT_TRUE(file);
    EXPECT_EQ(text_of(*file), text);
    file->release(bytes);
    EXPECT_EQ(text_of(*file), text);
    std::filesystem::remove(dir / "file");
  }
}

TEST(WorkFile, OpensNoDamagedFile) {
  const TempDir dir;
  EXPECT_FALSE(WorkFile::open(dir / "none", kKey, {}));
  write(dir / "file", 300);
  EXPECT_FALSE(WorkFile::open(dir / "file", kKey + 1, {})) << "of another job";
  const std::string whole = read_text(dir / "file");
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    write_text(dir / "file", whole.substr(0, size));
    EXPECT_FALSE(WorkFile::open(dir / "file", kKey, {})) << size;
  }
  write_text(dir / "file", whole + "x");
  EXPECT_FALSE(WorkFile::open(dir / "file", kKey, {}));
  for (std::size_t at = 0; at < whole.size(); at += at == 31 ? 33 : 1) {  // not the zeros
    std::string damaged = whole;
    damaged[at] ^= 4;
    write_text(dir / "file", damaged);
    EXPECT_FALSE(WorkFile::open(dir / "file", kKey, {})) << at;
  }
}

TEST(WorkFile, AppearsOnlyWhenItIsComplete) {
  const TempDir dir;
  { WorkFileWriter file(dir / "file", kKey); }
  EXPECT_EQ(dir.count(), 0);
}

}  // namespace
}  // namespace voxdag
