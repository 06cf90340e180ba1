#pragma once
/// Reads and writes NumPy's .npy arrays, a few rows at a time.
///
/// Format: numpy.lib.format; reads versions 1.0 to 3.0, writes 1.0; C order, little-endian. A row
/// is one step along the first axis: 8 items for the shape (N, 8), one for a structured array (N,).
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {

struct NpyHeader {
  std::string dtype;  ///< "<f4"; for a structured array the literal list, "[('t', '<f4')]".
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
  friend bool operator==(const NpyHeader&, const NpyHeader&) = default;
};

/// Parses the dictionary of a header. Throws Error with the byte, counted from `first_byte`.
NpyHeader parse_npy_header(std::string_view text, std::uint64_t first_byte);

/// The header of a file, and the byte at which its items begin.
struct NpyStart {
  NpyHeader header;
  std::uint64_t data = 0;
};

/// Reads the start of a file with an array of any type. Throws Error with path and byte.
NpyStart read_npy_start(const std::filesystem::path& path);

/// Reads arrays of one expected type. Works on files and pipes; memory does not grow with N.
class NpyReader {
 public:
  /// Opens `path` and checks that it has this dtype, C order and the shape (N, row_shape...).
  /// `item_bytes` is the size of the dtype. A file must have exactly the size that its shape
  /// implies. Throws Error with path and byte.
  NpyReader(const std::filesystem::path& path, const std::string& dtype,
            const std::vector<std::uint64_t>& row_shape, std::size_t item_bytes);
  /// Opens `path` like an array of '<f4', or of '<f8': see has_doubles().
  NpyReader(const std::filesystem::path& path, const std::vector<std::uint64_t>& row_shape);
  NpyReader(const NpyReader&) = delete;
  NpyReader& operator=(const NpyReader&) = delete;

  std::uint64_t rows() const { return rows_; }  ///< N
  std::size_t row_bytes() const { return row_bytes_; }
  bool has_doubles() const { return has_doubles_; }  ///< Items are '<f8'.

  /// Reads the next rows, at most `most_rows`, into `out` (row_bytes() each). Returns the number of
  /// rows read: less than `most_rows` only at the end, and then 0.
  std::size_t read_rows(void* out, std::size_t most_rows);

 private:
  friend NpyStart read_npy_start(const std::filesystem::path& path);
  /// Opens `path` and reads nothing.
  explicit NpyReader(const std::filesystem::path& path);
  void check_header(const NpyHeader& header, const std::string& dtype,
                    const std::vector<std::uint64_t>& row_shape, std::size_t item_bytes);
  void read_exactly(void* out, std::size_t bytes);
  NpyHeader read_header();
  void check_size() const;
  [[noreturn]] void fail(const std::string& reason) const;

  std::filesystem::path path_;
  Descriptor input_;
  std::optional<std::uint64_t> file_bytes_;  ///< Size of a regular file; none for a pipe.
  std::uint64_t position_ = 0;
  bool has_doubles_ = false;
  std::uint64_t rows_ = 0, rows_read_ = 0;
  std::size_t row_bytes_ = 0;
};

/// Writes an array row by row into a file that appears when it is complete (see AtomicFile).
class NpyWriter {
 public:
  /// `dtype` is as in NpyHeader, with `item_bytes` per item. A row has the product of `row_shape`
  /// items ({} for a structured array of shape (N,)). If `rows` is not given, N is the number of
  /// rows written before commit(), and the output must be seekable.
  NpyWriter(const std::filesystem::path& path, std::string dtype,
            std::vector<std::uint64_t> row_shape, std::size_t item_bytes,
            std::optional<std::uint64_t> rows = {});

  /// Appends `count` rows of row_bytes() each.
  void write_rows(const void* data, std::size_t count) { write_bytes(data, count * row_bytes_); }
  /// Appends any number of bytes, also parts of a row.
  void write_bytes(const void* data, std::size_t bytes);
  std::uint64_t rows_written() const { return bytes_written_ / row_bytes_; }

  /// Completes the header and gives the file its name. If `rows` was given, exactly that many must
  /// have been written.
  void commit();

 private:
  std::string header(std::uint64_t rows) const;

  AtomicFile file_;
  std::string dtype_;
  std::vector<std::uint64_t> row_shape_;
  std::size_t row_bytes_;
  std::optional<std::uint64_t> rows_;
  std::uint64_t bytes_written_ = 0;
};

}  // namespace voxdag
