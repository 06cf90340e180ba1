#include "voxdag/formats/input_file.hpp"

#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/io/nameless_file.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/formats/imports/volumes/gzip_stream.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kGzip = "\x1f\x8b", kZstd = "\x28\xb5\x2f\xfd";
constexpr std::size_t kPartBytes = std::size_t{1} << 18;

/// A file in memory without a name.
class MemoryFile {
 public:
  MemoryFile(const fs::path& given, Work work)
      : given_(given), work_(work), descriptor_(open_memory_file()), reservation_(work.memory, 0) {
    if (!descriptor_.is_open()) fail("cannot unpack");
  }

  void write(std::span<const std::byte> bytes) {
    work_.poll();
    try {
      reservation_.resize(reservation_.bytes() + bytes.size());
    } catch (const OverMemory& over) {
      throw OverMemory(given_.string(), "", over.reason());
    }
    while (!bytes.empty()) {
      const ssize_t count = ::write(descriptor_.get(), bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) fail("cannot unpack");
      if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }

  Descriptor& descriptor() { return descriptor_; }
  MemoryReservation& reservation() { return reservation_; }

 private:
  [[noreturn]] void fail(const char* action) const {
    throw Error(given_.string(), "",
                std::string(action) + ": " + std::system_category().message(errno));
  }

  const fs::path& given_;
  Work work_;
  Descriptor descriptor_;
  MemoryReservation reservation_;
};

void read_pipe(const fs::path& given, int from, MemoryFile& to) {
  std::vector<std::byte> part(kPartBytes);
  for (;;) {
    const ssize_t count = ::read(from, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      throw Error(given.string(), "", "cannot read: " + std::system_category().message(errno));
    if (count == 0) return;
    to.write({part.data(), static_cast<std::size_t>(count)});
  }
}

/// Returns the path that opens the bytes of one of this process's descriptors: a copy of a pipe,
/// which is read only once.
fs::path path_of_input(const fs::path& given, int descriptor, Work work) {
  struct stat info {};
  if (::fstat(descriptor, &info) != 0)
    throw Error(given.string(), "", "cannot open: " + std::system_category().message(errno));
  if (!S_ISFIFO(info.st_mode) && !S_ISSOCK(info.st_mode)) return path_of_descriptor(descriptor);
  static std::mutex mutex;
  static std::map<int, Descriptor> copies;
  const std::lock_guard lock(mutex);
  const auto [copy, is_new] = copies.try_emplace(descriptor);
  if (is_new) {
    try {
      MemoryFile memory(given, work);
      read_pipe(given, descriptor, memory);
      memory.reservation().keep();
      copy->second = std::move(memory.descriptor());
    } catch (...) {
      copies.erase(copy);
      throw;
    }
  }
  return path_of_descriptor(copy->second.get());
}

void unpack_gzip(const fs::path& given, std::string_view bytes, MemoryFile& to) {
  GzipStream stream(given, bytes, 0);
  std::vector<std::byte> part(kPartBytes);
  while (const std::size_t count = stream.read(part)) to.write({part.data(), count});
}

void unpack_zstd(const fs::path& given, std::string_view bytes, MemoryFile& to) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  std::vector<std::byte> part(kPartBytes);
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t left = 1;  // 0: at the end of a frame.
  for (bool is_part_full = false; in.pos < in.size || is_part_full;) {
    ZSTD_outBuffer out{part.data(), part.size(), 0};
    left = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(left) != 0)
      throw Error(given.string(), ErrorPlace::byte(in.pos),
                  std::string("the compressed data are damaged: ") + ZSTD_getErrorName(left));
    to.write({part.data(), out.pos});
    is_part_full = out.pos == out.size;
  }
  if (left != 0)
    throw Error(given.string(), ErrorPlace::byte(in.pos), "the compressed data end early");
}

}  // namespace

InputFile::InputFile(const fs::path& given, Work work) : path_(given), name_(given) {
  const int descriptor = given == "-" ? STDIN_FILENO : resolve_output(given).descriptor;
  if (descriptor >= 0) path_ = path_of_input(given, descriptor, work);
  is_in_memory_ = descriptor >= 0;
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) return;
  const OpenInput input = [&] {
    try {
      return open_input(path_);
    } catch (const Error& error) {
      throw error.in_file(given.string());
    }
  }();
  std::array<char, kZstd.size()> head{};
  if (::pread(input.descriptor.get(), head.data(), head.size(), 0) < 0) return;
  const std::string_view magic(head.data(), head.size());
  const bool is_gzip = magic.starts_with(kGzip);
  if (!is_gzip && magic != kZstd) return;
  name_ = unpacked_name(given);
  const MappedFile packed(input, given, MappedFile::Access::kSequential);
  MemoryFile memory(given, work);
  is_gzip ? unpack_gzip(given, packed.text(), memory) : unpack_zstd(given, packed.text(), memory);
  memory_ = std::move(memory.descriptor());
  reservation_ = std::move(memory.reservation());
  path_ = path_of_descriptor(memory_.get());
  is_in_memory_ = true;
}

}  // namespace voxdag
