#include "voxdag/cluster/one_rank.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {
namespace {

class LocalFile final : public RankFile {
 public:
  explicit LocalFile(const std::filesystem::path& path)
      : path_(path), descriptor_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (!descriptor_.is_open()) fail(0, "cannot open: ");
  }

  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    while (!bytes.empty()) {
      const ssize_t written =
          ::pwrite(descriptor_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(offset, "cannot write: ");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      offset += static_cast<std::uint64_t>(written);
    }
  }

  void close() override {
    // Some file systems (NFS, quotas) report a failed write only here.
    if (::close(descriptor_.release()) != 0) fail(0, "cannot write: ");
  }

 private:
  [[noreturn]] void fail(std::uint64_t offset, const char* what) const {
    throw Error(path_.string(), ErrorPlace::byte(offset),
                what + std::system_category().message(errno));
  }

  std::filesystem::path path_;
  Descriptor descriptor_;
};

}  // namespace

std::unique_ptr<RankFile> OneRank::open_file(const std::filesystem::path& path) {
  return std::make_unique<LocalFile>(path);
}

void OneRank::abort(int status) { ::_exit(status); }

}  // namespace voxdag
