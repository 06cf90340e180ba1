#include "voxdag/formats/exports/zip_file.hpp"

#include <minizip/zip.h>

#include <exception>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag {

/// The output of minizip. Exceptions must not pass through minizip.
struct ZipOutput {
  AtomicFile file;
  std::uint64_t at = 0;
  std::exception_ptr failure;

  uLong write(const char* bytes, uLong size) try {
    const std::uint64_t end = file.position(), inside = std::min<std::uint64_t>(size, end - at);
    if (inside > 0) file.overwrite(at, bytes, inside);
    file.write(bytes + inside, size - inside);
    at += size;
    return size;
  } catch (...) {
    failure = std::current_exception();
    return 0;
  }
  long seek(ZPOS64_T offset, int origin) {
    at = offset + (origin == ZLIB_FILEFUNC_SEEK_CUR   ? at
                   : origin == ZLIB_FILEFUNC_SEEK_END ? file.position()
                                                      : 0);
    return at <= file.position() ? 0 : -1;
  }
};

namespace {

ZipOutput& output_of(voidpf stream) { return *static_cast<ZipOutput*>(stream); }

zlib_filefunc64_def functions_for(ZipOutput& output) {
  zlib_filefunc64_def functions{};
  functions.opaque = &output;
  functions.zopen64_file = [](voidpf opaque, const void*, int) { return opaque; };
  functions.zread_file = [](voidpf, voidpf, void*, uLong) -> uLong { return 0; };
  functions.zwrite_file = [](voidpf, voidpf stream, const void* bytes, uLong size) {
    return output_of(stream).write(static_cast<const char*>(bytes), size);
  };
  functions.ztell64_file = [](voidpf, voidpf stream) -> ZPOS64_T { return output_of(stream).at; };
  functions.zseek64_file = [](voidpf, voidpf stream, ZPOS64_T offset, int origin) {
    return output_of(stream).seek(offset, origin);
  };
  functions.zclose_file = [](voidpf, voidpf) { return 0; };
  functions.zerror_file = [](voidpf, voidpf) { return 0; };
  return functions;
}

}  // namespace

struct ZipFile::Archive {
  ZipOutput output;
  zipFile zip = nullptr;
  bool is_open = false;  ///< A file in the archive.

  explicit Archive(const std::filesystem::path& path) : output{AtomicFile(path), 0, {}} {
    zlib_filefunc64_def functions = functions_for(output);
    zip = zipOpen2_64("", APPEND_STATUS_CREATE, nullptr, &functions);
    if (zip == nullptr) throw std::bad_alloc();
  }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  ~Archive() {
    if (zip != nullptr) zipClose(zip, nullptr);
  }

  /// Throws the Error of the output, or one of its own, if a call failed.
  void check(int status) const {
    if (output.failure) std::rethrow_exception(output.failure);
    if (status != ZIP_OK)
      throw Error(output.file.path().string(), "",
                  "the archive cannot be written: zip error " + std::to_string(status));
  }
  void end() {
    if (std::exchange(is_open, false)) check(zipCloseFileInZip(zip));
  }
};

ZipFile::ZipFile(const std::filesystem::path& path) : archive_(std::make_unique<Archive>(path)) {}

ZipFile::~ZipFile() = default;

void ZipFile::begin(const char* name, std::uint64_t most_bytes) {
  archive_->end();
  zip_fileinfo info{};
  info.dosDate = (1 << 5 | 1) << 16;  // 1980-01-01, the first day of this calendar.
  const bool is_large = most_bytes > 0xFFFFFFFF;
  archive_->check(zipOpenNewFileInZip64(archive_->zip, name, &info, nullptr, 0, nullptr, 0, nullptr,
                                        Z_DEFLATED, Z_BEST_SPEED, is_large ? 1 : 0));
  archive_->is_open = true;
}

void ZipFile::write(std::string_view bytes) {
  archive_->check(
      zipWriteInFileInZip(archive_->zip, bytes.data(), static_cast<unsigned>(bytes.size())));
}

void ZipFile::commit() {
  archive_->end();
  archive_->check(zipClose(std::exchange(archive_->zip, nullptr), nullptr));
  archive_->output.file.commit();
}

}  // namespace voxdag
