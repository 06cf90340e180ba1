#include "voxdag/algebra/voxels/run_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/nameless_file.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

[[noreturn]] void fail(const std::filesystem::path& folder, const char* what) {
  throw Error(folder.string(), "",
              std::string("cannot ") + what +
                  " a file for sorting: " + std::system_category().message(errno));
}

Descriptor make_file(const std::filesystem::path& folder) {
  Descriptor file = open_scratch_file(folder);
  if (!file.is_open()) fail(folder, "create");
  return file;
}

}  // namespace

RunFile::RunFile(std::filesystem::path folder)
    : folder_(std::move(folder)), file_(make_file(folder_)) {}

void RunFile::write(const void* bytes, std::size_t count, Work work) {
  const auto* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t put = ::write(file_.get(), at, std::min<std::size_t>(count, 1 << 24));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) fail(folder_, "write");
    work.poll();
    at += put;
    count -= static_cast<std::size_t>(put);
  }
}

void RunFile::read(void* bytes, std::size_t count, std::uint64_t offset) const {
  auto* at = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = ::pread(file_.get(), at, count, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail(folder_, "read");
    at += got;
    offset += static_cast<std::uint64_t>(got);
    count -= static_cast<std::size_t>(got);
  }
}

}  // namespace voxdag
