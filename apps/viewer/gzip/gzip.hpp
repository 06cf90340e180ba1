#pragma once
/// The gzip format, by zlib. Equal bytes give equal results: they hold no time and no name.
#include <zlib.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Compresses bytes that arrive piece by piece.
class Gzip {
 public:
  Gzip() {
    constexpr int kWindowBits = 15, kGzipFormat = 16, kMemoryLevel = 9;
    if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kWindowBits + kGzipFormat,
                     kMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK)
      throw Error("cannot compress: out of memory");
  }
  Gzip(const Gzip&) = delete;
  Gzip& operator=(const Gzip&) = delete;
  ~Gzip() { deflateEnd(&stream_); }

  /// Calls body(std::string_view) for pieces of the result.
  template <class Body>
  void add(std::span<const std::byte> bytes, const Body& body) {
    // zlib's parameter has no const, but it does not write.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
    stream_.avail_in = static_cast<uInt>(bytes.size());
    run(Z_NO_FLUSH, body);
  }
  template <class Body>
  void finish(const Body& body) {
    run(Z_FINISH, body);
  }

 private:
  template <class Body>
  void run(int flush, const Body& body) {
    do {
      char out[16384];
      stream_.next_out = reinterpret_cast<Bytef*>(out);
      stream_.avail_out = sizeof out;
      deflate(&stream_, flush);
      body(std::string_view(out, sizeof out - stream_.avail_out));
    } while (stream_.avail_out == 0);
  }

  z_stream stream_{};
};

/// Returns the compressed bytes.
inline std::string gzip(std::string_view bytes) {
  std::string compressed;
  const auto append = [&compressed](std::string_view piece) { compressed += piece; };
  Gzip stream;
  stream.add(std::as_bytes(std::span(bytes)), append);
  stream.finish(append);
  return compressed;
}

}  // namespace voxdag
