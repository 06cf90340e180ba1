#pragma once
/// Reads the schematics that exports write.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace voxdag {

inline std::string unzipped(const std::filesystem::path& path) {
  const gzFile file = gzopen(path.c_str(), "rb");
  std::string text;
  char buffer[4096];
  for (int count; (count = gzread(file, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(count));
  EXPECT_EQ(gzclose(file), Z_OK);
  return text;
}

/// The tags of a schematic: numbers, the palette, and the blocks.
struct Nbt {
  std::map<std::string, std::int32_t> numbers, palette;
  std::string blocks;

  explicit Nbt(std::string nbt) : bytes(std::move(nbt)) {
    EXPECT_EQ(number(1), 10);
    EXPECT_EQ(name(), "Schematic");
    read_compound(numbers);
    EXPECT_EQ(at, bytes.size());
  }

 private:
  std::int32_t number(int count) {
    std::int32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at++));
    return value;
  }
  std::string name() {
    const auto length = static_cast<std::size_t>(number(2));
    at += length;
    return bytes.substr(at - length, length);
  }
  void read_compound(std::map<std::string, std::int32_t>& into) {
    for (int type; (type = number(1)) != 0;) {
      const std::string tag = name();
      if (type == 2) into[tag] = number(2);
      if (type == 3) into[tag] = number(4);
      if (type == 7) {
        const auto count = static_cast<std::size_t>(number(4));
        blocks = bytes.substr(at, count);
        at += count;
      }
      if (type == 9) at += 5;
      if (type == 10) read_compound(palette);
      if (type == 11) at += 4 * static_cast<std::size_t>(number(4));
    }
  }
  std::string bytes;
  std::size_t at = 0;
};

}  // namespace voxdag
