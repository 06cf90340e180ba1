#include "voxdag/formats/imports/volumes/gzip_stream.hpp"

#include <algorithm>
#include <new>
#include <vector>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Zlib counts in 32 bits.
constexpr std::size_t kMaxAtOnce = std::size_t{1} << 30;
/// The largest window, and the detection of gzip or zlib by the header.
constexpr int kAnyHeader = 15 + 32;

}  // namespace

GzipStream::GzipStream(std::filesystem::path path, std::string_view bytes, std::uint64_t begin)
    : path_(std::move(path)), bytes_(bytes), at_(begin) {
  if (inflateInit2(&stream_, kAnyHeader) != Z_OK) throw std::bad_alloc();
}

GzipStream::~GzipStream() { inflateEnd(&stream_); }

std::size_t GzipStream::read(std::span<std::byte> bytes) {
  std::size_t written = 0;
  while (written < bytes.size() && !is_at_end_) {
    if (stream_.avail_in == 0) {
      const std::string_view part = bytes_.substr(at_, kMaxAtOnce);
      // Zlib does not change its input.
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
      stream_.avail_in = static_cast<uInt>(part.size());
      at_ += part.size();
    }
    const std::size_t room = std::min(bytes.size() - written, kMaxAtOnce);
    stream_.next_out = reinterpret_cast<Bytef*>(bytes.data() + written);
    stream_.avail_out = static_cast<uInt>(room);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    written += room - stream_.avail_out;
    if (status == Z_STREAM_END)
      is_at_end_ = !start_next_member();
    else if (status == Z_MEM_ERROR)
      throw std::bad_alloc();
    else if (status == Z_BUF_ERROR)
      fail("the compressed data end early");
    else if (status != Z_OK)
      fail("the compressed data are damaged");
  }
  return written;
}

void GzipStream::fill(std::span<std::byte> bytes) {
  if (read(bytes) < bytes.size()) fail("the compressed data end early");
}

void GzipStream::skip(std::uint64_t count) {
  std::vector<std::byte> buffer(std::size_t{1} << 16);
  while (count > 0) {
    const std::size_t part = std::min<std::uint64_t>(count, buffer.size());
    fill({buffer.data(), part});
    count -= part;
  }
}

void GzipStream::expect_end() {
  std::byte more;
  if (read({&more, 1}) > 0) fail("the compressed data are longer than the volume");
}

bool GzipStream::start_next_member() {
  const std::string_view rest = bytes_.substr(at_ - stream_.avail_in);
  return rest.starts_with("\x1f\x8b") && inflateReset(&stream_) == Z_OK;
}

void GzipStream::fail(const char* reason) const {
  throw Error(path_.string(), ErrorPlace::byte(at_ - stream_.avail_in), reason);
}

}  // namespace voxdag
