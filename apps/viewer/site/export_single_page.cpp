#include <zlib.h>

#include <string_view>

#include "viewer/site/base64.hpp"
#include "viewer/site/export_site.hpp"
#include "viewer/site/scene_pieces.hpp"
#include "viewer/site/single_page.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/io/atomic_file.hpp"

namespace voxdag {
namespace {

/// Compresses bytes that arrive piece by piece, in the format of gzip, without a time or a name.
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

}  // namespace

std::uint64_t export_single_page(const std::filesystem::path& path, const SceneBytes& scene,
                                 Progress* progress) {
  const SinglePage page = make_single_page(page_files());
  AtomicFile file(path);
  file.write(page.before);
  Gzip gzip;
  Base64 encoder;
  const auto write = [&](std::string_view compressed) { file.write(encoder.add(compressed)); };
  for_each_piece(scene, progress, [&](auto piece) { gzip.add(piece, write); });
  gzip.finish(write);
  file.write(encoder.finish());
  file.write(page.after);
  const std::uint64_t bytes = file.position();
  file.commit();
  return bytes;
}

}  // namespace voxdag
