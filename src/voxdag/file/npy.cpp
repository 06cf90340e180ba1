#include "voxdag/file/npy.hpp"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <limits>
#include <span>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/open_input.hpp"
#include "voxdag/core/with_file_name.hpp"

namespace voxdag {
namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kPrefixBytes = 10;  ///< Magic, version and length of version 1.0.
constexpr std::uint32_t kMaxHeaderBytes = 1 << 20;
/// Space that the writer reserves for N: the digits of 2^64.
constexpr std::size_t kMaxDigits = 20;

std::string dtype_literal(const std::string& dtype) {
  return dtype.starts_with('[') ? dtype : "'" + dtype + "'";
}

/// Returns Python's form of a shape, "(5,)" or "(5, 8)", with `first` for the first number.
std::string shape_literal(const std::string& first, std::span<const std::uint64_t> rest) {
  std::string text = "(" + first + ",";
  for (std::size_t i = 0; i < rest.size(); ++i)
    text += (i == 0 ? " " : ", ") + std::to_string(rest[i]);
  return text + ")";
}

std::size_t items_per_row(const std::vector<std::uint64_t>& row_shape) {
  std::size_t items = 1;
  for (const std::uint64_t size : row_shape) items *= size;
  return items;
}

}  // namespace

NpyReader::NpyReader(const std::filesystem::path& path) : path_(path) {
  OpenInput input = open_input(path, InputKind::kFileOrPipe);
  input_ = std::move(input.descriptor);
  file_bytes_ = input.size;
}

NpyReader::NpyReader(const std::filesystem::path& path, const std::string& dtype,
                     const std::vector<std::uint64_t>& row_shape, std::size_t item_bytes)
    : NpyReader(path) {
  check_header(read_header(), dtype, row_shape, item_bytes);
}

NpyReader::NpyReader(const std::filesystem::path& path, const std::vector<std::uint64_t>& row_shape)
    : NpyReader(path) {
  const NpyHeader header = read_header();
  has_doubles_ = header.dtype == "<f8";
  check_header(header, has_doubles_ ? "<f8" : "<f4", row_shape, has_doubles_ ? 8 : 4);
}

void NpyReader::check_header(const NpyHeader& header, const std::string& dtype,
                             const std::vector<std::uint64_t>& row_shape, std::size_t item_bytes) {
  row_bytes_ = items_per_row(row_shape) * item_bytes;
  if (header.dtype != dtype)
    fail("items must be " + dtype_literal(dtype) + ", not " + dtype_literal(header.dtype));
  if (header.shape.empty() || !std::equal(header.shape.begin() + 1, header.shape.end(),
                                          row_shape.begin(), row_shape.end())) {
    const std::string found =
        header.shape.empty()
            ? "()"
            : shape_literal(std::to_string(header.shape[0]), std::span(header.shape).subspan(1));
    fail("the shape must be " + shape_literal("N", row_shape) + ", not " + found);
  }
  if (header.fortran_order) fail("the array must be in C order, not in Fortran order");
  rows_ = header.shape[0];
  if (rows_ > std::numeric_limits<std::int64_t>::max() / row_bytes_ / 2)
    fail("an array of " + std::to_string(rows_) + " rows is too large");
  check_size();
}

std::size_t NpyReader::read_rows(void* out, std::size_t most_rows) {
  const auto count =
      static_cast<std::size_t>(std::min<std::uint64_t>(most_rows, rows_ - rows_read_));
  read_exactly(out, count * row_bytes_);
  rows_read_ += count;
  return count;
}

void NpyReader::read_exactly(void* out, std::size_t bytes) {
  auto* to = static_cast<char*>(out);
  while (bytes > 0) {
    const ssize_t got = ::read(input_.get(), to, bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot read: " + std::system_category().message(errno));
    if (got == 0) fail("truncated: " + std::to_string(bytes) + " bytes are missing");
    to += got;
    bytes -= static_cast<std::size_t>(got);
    position_ += static_cast<std::uint64_t>(got);
  }
}

NpyHeader NpyReader::read_header() {
  char magic[8];
  read_exactly(magic, sizeof magic);
  if (std::string_view(magic, kMagic.size()) != kMagic) {
    position_ = 0;
    fail("not a .npy file");
  }
  const int major = static_cast<unsigned char>(magic[6]);
  if (major < 1 || major > 3)
    fail(".npy version " + std::to_string(major) + " is unknown: only versions 1 to 3 are read");
  std::uint32_t length = 0;
  read_exactly(&length, major == 1 ? 2 : 4);
  if (length > kMaxHeaderBytes)
    fail("the header has " + std::to_string(length) + " bytes, more than " +
         std::to_string(kMaxHeaderBytes));
  const std::uint64_t first_byte = position_;
  std::string text(length, '\0');
  read_exactly(text.data(), length);
  return with_file_name(path_.string(), [&] { return parse_npy_header(text, first_byte); });
}

NpyStart read_npy_start(const std::filesystem::path& path) {
  NpyReader reader(path);
  NpyStart start{reader.read_header()};
  start.data = reader.position_;
  return start;
}

void NpyReader::check_size() const {
  if (!file_bytes_) return;
  const std::uint64_t size = *file_bytes_;
  const std::uint64_t expected = position_ + rows_ * row_bytes_;
  if (size != expected)
    throw Error(path_.string(), ErrorPlace::byte(std::min(size, expected)),
                (size < expected ? "truncated: " : "trailing bytes: ") + std::to_string(rows_) +
                    " rows need " + std::to_string(expected) + " bytes");
}

void NpyReader::fail(const std::string& reason) const {
  throw Error(path_.string(), ErrorPlace::byte(position_), reason);
}

NpyWriter::NpyWriter(const std::filesystem::path& path, std::string dtype,
                     std::vector<std::uint64_t> row_shape, std::size_t item_bytes,
                     std::optional<std::uint64_t> rows)
    : file_(path),
      dtype_(std::move(dtype)),
      row_shape_(std::move(row_shape)),
      row_bytes_(items_per_row(row_shape_) * item_bytes),
      rows_(rows) {
  file_.write(header(rows_.value_or(0)));
}

void NpyWriter::write_bytes(const void* data, std::size_t bytes) {
  file_.write(data, bytes);
  bytes_written_ += bytes;
}

void NpyWriter::commit() {
  assert(bytes_written_ % row_bytes_ == 0 && (!rows_ || *rows_ == rows_written()));
  if (!rows_) {
    const std::string complete = header(rows_written());
    file_.overwrite(0, complete.data(), complete.size());
  }
  file_.commit();
}

std::string NpyWriter::header(std::uint64_t rows) const {
  const std::string number = std::to_string(rows);
  std::string dictionary =
      "{'descr': " + dtype_literal(dtype_) +
      ", 'fortran_order': False, 'shape': " + shape_literal(number, row_shape_) + ", }";
  // The header is as long as for the largest N, so that it can be overwritten. It aligns the data
  // to 64 bytes.
  const std::size_t longest = kPrefixBytes + dictionary.size() - number.size() + kMaxDigits + 1;
  const std::size_t padded = (longest + 63) / 64 * 64;
  dictionary.resize(padded - kPrefixBytes - 1, ' ');
  dictionary += '\n';
  assert(dictionary.size() <= 0xFFFF);
  std::string text(kMagic);
  text += {'\x01', '\x00', static_cast<char>(dictionary.size() & 0xFF),
           static_cast<char>(dictionary.size() >> 8)};
  return text + dictionary;
}

}  // namespace voxdag
