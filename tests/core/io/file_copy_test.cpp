#include "voxdag/core/io/file_copy.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

std::string text_of(const FileCopy& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

TEST(FileCopy, KeepsTheBytesOfTheFile) {
  const TempDir dir;
  for (const std::size_t size : {0, 1, 4096, 3 << 20}) {
    std::string text(size, '\0');
    for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i * 7 % 251);
    write_text(dir / "in", text);
    const FileCopy file(dir / "in");
    EXPECT_EQ(text_of(file), text);
    std::fstream(dir / "in") << "other bytes, in place";
    EXPECT_EQ(text_of(file), text);
    std::filesystem::resize_file(dir / "in", 0);
    EXPECT_EQ(text_of(file), text);
  }
}

TEST(FileCopy, NamesTheFileInErrors) {
  const TempDir dir;
  try {
    const FileCopy file(dir / "none");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), (dir / "none").string());
  }
  write_text(dir / "in", "seven b");
  EXPECT_THROW(FileCopy(dir / "in", {6, "a test"}), Error);
}

}  // namespace
}  // namespace voxdag
