#include "voxdag/formats/exports/grids/gzip_file.hpp"

#include <zlib.h>

#include <array>
#include <limits>
#include <new>

#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag {

struct GzipFile::Deflater {
  AtomicFile file;
  z_stream stream{};

  explicit Deflater(const std::filesystem::path& path) : file(path) {
    constexpr int kWindowBits = 15, kGzip = 16, kMemory = 8;
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kWindowBits + kGzip, kMemory,
                     Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  ~Deflater() { deflateEnd(&stream); }

  void run(std::string_view bytes, int flush) {
    std::array<Bytef, 16384> out;
    do {
      const std::size_t part =
          std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
      // zlib does not write to its input.
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream.avail_in = static_cast<uInt>(part);
      bytes.remove_prefix(part);
      do {
        stream.next_out = out.data();
        stream.avail_out = out.size();
        deflate(&stream, bytes.empty() ? flush : Z_NO_FLUSH);
        file.write(out.data(), out.size() - stream.avail_out);
      } while (stream.avail_out == 0);
    } while (!bytes.empty());
  }
};

GzipFile::GzipFile(const std::filesystem::path& path)
    : deflater_(std::make_unique<Deflater>(path)) {}

GzipFile::~GzipFile() = default;

void GzipFile::write(std::string_view bytes) { deflater_->run(bytes, Z_NO_FLUSH); }

void GzipFile::commit() {
  deflater_->run({}, Z_FINISH);
  deflater_->file.commit();
}

}  // namespace voxdag
