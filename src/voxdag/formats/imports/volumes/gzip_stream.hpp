#pragma once
/// Decompresses a part of a file as it is read.
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace voxdag {

/// The bytes of one or more gzip members (RFC 1952), or of a zlib stream (RFC 1950), from a byte of
/// a file to its end. Memory: that of zlib's window. All functions throw Error with the byte of the
/// file if the data are damaged.
class GzipStream {
 public:
  /// The bytes must outlive the stream.
  GzipStream(std::filesystem::path path, std::string_view bytes, std::uint64_t begin);
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;
  ~GzipStream();

  /// Throws if the stream has fewer bytes.
  void fill(std::span<std::byte> bytes);
  void skip(std::uint64_t count);
  /// Throws if there are more bytes, or if the checksum is wrong.
  void expect_end();
  /// Returns how many bytes it wrote: fewer than asked only at the end.
  std::size_t read(std::span<std::byte> bytes);

 private:
  [[noreturn]] void fail(const char* reason) const;
  /// Continues with the next member; returns whether there is one.
  bool start_next_member();

  std::filesystem::path path_;
  std::string_view bytes_;
  std::uint64_t at_;  ///< First byte that zlib does not have yet.
  z_stream stream_{};
  bool is_at_end_ = false;
};

}  // namespace voxdag
