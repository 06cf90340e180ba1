#include "voxdag/file/npy.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <thread>

#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Returns the bytes of a version 1.0 file as NumPy writes it.
std::string npy_bytes(std::string dictionary, const std::string& data) {
  dictionary.resize((dictionary.size() + 10 + 64) / 64 * 64 - 11, ' ');
  dictionary += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(dictionary.size() & 0xFF);
  bytes += static_cast<char>(dictionary.size() >> 8);
  return bytes + dictionary + data;
}

std::string rays_header(const std::string& shape) {
  return "{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }";
}

/// Opens `bytes` as rays and reads them all. Returns the error without the file's name.
std::string npy_error_of(const std::string& bytes) {
  const TempDir dir;
  write_text(dir / "a.npy", bytes);
  try {
    NpyReader reader(dir / "a.npy", "<f4", {8}, 4);
    std::array<float, 8> row{};
    while (reader.read_rows(row.data(), 1) != 0) {
    }
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), (dir / "a.npy").string());
    return error.place().text() + ": " + error.reason();
  }
  return "no error";
}

TEST(Npy, ReadsBackWhatItWroteInRunsOfAnyLength) {
  const TempDir dir;
  for (const std::size_t rows : {0, 1, 7, 1000, 100000}) {
    std::vector<float> values(rows * 8);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    NpyWriter writer(dir / "a.npy", "<f4", {8}, 4);
    for (std::size_t at = 0, step = 1; at < rows; at += step, step = std::min(2 * step, rows - at))
      writer.write_rows(&values[8 * at], step);
    writer.commit();

    NpyReader reader(dir / "a.npy", "<f4", {8}, 4);
    ASSERT_EQ(reader.rows(), rows);
    EXPECT_EQ(reader.row_bytes(), 32u);
    std::vector<float> back(rows * 8 + 8 * 333);
    std::size_t got = 0;
    while (const std::size_t now = reader.read_rows(&back[8 * got], 333)) got += now;
    back.resize(rows * 8);
    EXPECT_EQ(got, rows);
    EXPECT_EQ(back, values);
  }
}

TEST(Npy, TheHeaderIsTheOneOfTheFormat) {
  const TempDir dir;
  NpyWriter writer(dir / "a.npy", "[('hit', '|u1'), ('t', '<f4')]", {}, 5, 2);
  writer.write_rows("123456789", 2);
  writer.commit();
  const std::string bytes = read_text(dir / "a.npy");
  ASSERT_EQ(bytes.size(), 128u + 10u);
  EXPECT_EQ(bytes.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  EXPECT_EQ(bytes.substr(10, 89),
            "{'descr': [('hit', '|u1'), ('t', '<f4')], 'fortran_order': False, 'shape': (2,), }"
            "       ");
  EXPECT_EQ(bytes[127], '\n');
}

TEST(Npy, KnownAndUnknownCountsMakeTheSameFile) {
  const TempDir dir;
  const std::int32_t values[6] = {1, 2, 3, 4, 5, 6};
  for (const bool known : {false, true}) {
    NpyWriter writer(dir / (known ? "a" : "b"), "<i4", {3}, 4,
                     known ? std::optional<std::uint64_t>(2) : std::nullopt);
    writer.write_rows(values, 2);
    writer.commit();
  }
  EXPECT_EQ(read_text(dir / "a"), read_text(dir / "b"));
}

TEST(Npy, ReadsWhatNumpyWrites) {
  const std::string row(32, '\0');
  EXPECT_EQ(npy_error_of(npy_bytes(rays_header("(2, 8)"), row + row)), "no error");
  EXPECT_EQ(npy_error_of(npy_bytes(rays_header("(0, 8)"), "")), "no error");
  EXPECT_EQ(
      npy_error_of(npy_bytes("{\"shape\":(1,8),\"fortran_order\":False,\"descr\":\"<f4\"}", row)),
      "no error");
  std::string version2 = npy_bytes(rays_header("(1, 8)"), row);
  version2[6] = 2;
  version2.insert(10, 2, '\0');
  EXPECT_EQ(npy_error_of(version2), "no error");
}

TEST(Npy, ReadsAPipe) {
  const TempDir dir;
  ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
  std::thread writer(
      [&] { write_text(dir / "pipe", npy_bytes(rays_header("(3, 8)"), std::string(96, 'x'))); });
  NpyReader reader(dir / "pipe", "<f4", {8}, 4);
  std::array<char, 96> rows{};
  EXPECT_EQ(reader.read_rows(rows.data(), 10), 3u);
  EXPECT_EQ(reader.read_rows(rows.data(), 10), 0u);
  writer.join();
}

TEST(Npy, EveryTruncationIsRefused) {
  const std::string bytes = npy_bytes(rays_header("(2, 8)"), std::string(64, '\0'));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(npy_error_of(bytes.substr(0, size)), "no error") << size;
  EXPECT_EQ(npy_error_of(bytes.substr(0, 150)), "byte 150: truncated: 2 rows need 192 bytes");
  EXPECT_EQ(npy_error_of(bytes + "x"), "byte 192: trailing bytes: 2 rows need 192 bytes");
}

TEST(Npy, NamesTheFault) {
  const auto header_error = [](const std::string& dictionary) {
    return npy_error_of(npy_bytes(dictionary, ""));
  };
  EXPECT_EQ(npy_error_of("some text that is no array"), "byte 0: not a .npy file");
  EXPECT_EQ(npy_error_of(std::string("\x93NUMPY\x07\x00..........", 18)),
            "byte 8: .npy version 7 is unknown: only versions 1 to 3 are read");
  EXPECT_EQ(header_error("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 8), }"),
            "byte 128: items must be '<f4', not '<f8'");
  EXPECT_EQ(header_error("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (0, 8), }"),
            "byte 128: items must be '<f4', not [('a', '<f4')]");
  EXPECT_EQ(header_error(rays_header("(0, 7)")), "byte 128: the shape must be (N, 8), not (0, 7)");
  EXPECT_EQ(header_error(rays_header("(8,)")), "byte 128: the shape must be (N, 8), not (8,)");
  EXPECT_EQ(header_error(rays_header("()")), "byte 128: the shape must be (N, 8), not ()");
  EXPECT_EQ(header_error("{'descr': '<f4', 'fortran_order': True, 'shape': (0, 8), }"),
            "byte 128: the array must be in C order, not in Fortran order");
  EXPECT_EQ(header_error(rays_header("(18446744073709551615, 8)")),
            "byte 128: an array of 18446744073709551615 rows is too large");
  EXPECT_EQ(header_error(rays_header("(18446744073709551616, 8)")),
            "byte 61: malformed header: expected a size");
  EXPECT_EQ(header_error(rays_header("(-1, 8)")), "byte 61: malformed header: expected a size");
  EXPECT_EQ(header_error("{'descr': '<f4'}"),
            "byte 64: the header must have 'descr', 'fortran_order' and 'shape'");
  EXPECT_EQ(header_error("{'other': '<f4'}"), "byte 19: unexpected key in the header");
  EXPECT_EQ(header_error("{'descr': '<f4"),
            "byte 20: malformed header: a string has no closing quote");
  EXPECT_EQ(header_error("{'descr': [[('<f4'"),
            "byte 64: malformed header: a list has no closing bracket");
  EXPECT_EQ(header_error("import os"), "byte 10: malformed header: expected '{'");
}

TEST(Npy, AMissingFileIsNamed) {
  EXPECT_THROW(NpyReader("/nonexistent/rays.npy", "<f4", {8}, 4), Error);
}

}  // namespace
}  // namespace voxdag
