#include "voxdag/cluster/named_output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/core/io/temporary_file.hpp"
#include "voxdag/core/io/unfinished_files.hpp"

namespace voxdag {

NamedOutput::NamedOutput(const std::filesystem::path& path, std::uint64_t bytes) : path_(path) {
  const ResolvedOutput output = resolve_output(path);
  if (output.error != 0) fail(output.error);
  if (path.filename().empty()) fail(ENOENT);
  target_ = std::filesystem::absolute(output.file);
  struct stat existing {};
  const bool exists = ::stat(target_.c_str(), &existing) == 0;
  if (output.descriptor >= 0 || (exists && !S_ISREG(existing.st_mode)))
    throw Error(path.string(), "", "cannot write: is not a regular file");
  if (exists && ::access(target_.c_str(), W_OK) != 0) fail(errno);

  remove_leftovers(target_);
  do {
    temporary_ = temporary_name(target_);
    lock_ = Descriptor(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  } while (!lock_.is_open() && errno == EEXIST);
  if (!lock_.is_open()) fail(errno);
  noted_ = note_unfinished(temporary_);
  lock_temporary(lock_.get());
  if (exists) ::fchmod(lock_.get(), existing.st_mode & 0777);
  if (::ftruncate(lock_.get(), static_cast<off_t>(bytes)) != 0) fail(errno);
}

NamedOutput::~NamedOutput() { discard(); }

void NamedOutput::publish() {
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  forget_unfinished(std::exchange(noted_, nullptr));
  temporary_.clear();
}

void NamedOutput::discard() noexcept {
  if (lock_.is_open() && !temporary_.empty()) ::unlink(temporary_.c_str());
  forget_unfinished(std::exchange(noted_, nullptr));
  temporary_.clear();
}

void NamedOutput::fail(int error) {
  discard();
  throw Error(path_.string(), "", "cannot write: " + std::system_category().message(error));
}

}  // namespace voxdag
