#include "voxdag/cluster/shared_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <exception>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/core/io/temporary_file.hpp"
#include "voxdag/core/io/unfinished_files.hpp"

namespace voxdag {
namespace {

/// Calls `work` on this rank. If it throws an Error on any rank, all ranks throw. Collective.
template <class Work>
void together(Ranks& ranks, const std::filesystem::path& path, const Work& work) {
  std::exception_ptr error;
  try {
    work();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& failure) {
    error = std::make_exception_ptr(failure.in_file(path.string()));
  }
  const std::uint64_t mine = error != nullptr ? 1 : 0;
  const std::vector<std::uint64_t> failed = ranks.all_gather({&mine, 1});
  if (error != nullptr) std::rethrow_exception(error);
  for (std::size_t rank = 0; rank < failed.size(); ++rank)
    if (failed[rank] != 0)
      throw Error(path.string(), "", "cannot write: rank " + std::to_string(rank) + " failed");
}

}  // namespace

/// An output file that other processes can open under a temporary name while it is incomplete.
///
/// Creates a file of zeros with a name from temporary_name(), beside the output. publish() renames
/// it. It is removed if it is destroyed before that, or by remove_unfinished_files(). AtomicFile
/// does this for one process; its files have no name, so that no other process can open them.
/// Every failure throws Error(path, "", the system's reason).
class NamedOutput {
 public:
  /// The output must not exist, or be a regular file; symbolic links are followed.
  NamedOutput(const std::filesystem::path& path, std::uint64_t bytes);
  NamedOutput(const NamedOutput&) = delete;
  NamedOutput& operator=(const NamedOutput&) = delete;
  ~NamedOutput();

  /// Returns the temporary name, an absolute path.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Gives the file the name of the output.
  void publish();

 private:
  [[noreturn]] void fail(int error);
  void discard() noexcept;

  std::filesystem::path path_;
  std::filesystem::path target_;     ///< With symbolic links resolved.
  std::filesystem::path temporary_;  ///< Empty after publish().
  char* noted_ = nullptr;            ///< Its handle in unfinished_files.hpp.
  Descriptor lock_;                  ///< Tells remove_leftovers() that this process is alive.
};

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

SharedFile::~SharedFile() = default;

SharedFile::SharedFile(Ranks& ranks, const std::filesystem::path& path, std::uint64_t bytes)
    : ranks_(ranks), path_(path), bytes_(bytes) {
  std::vector<std::byte> name;
  together(ranks, path, [&] {
    if (ranks.rank() != 0) return;
    output_ = std::make_unique<NamedOutput>(path, bytes);
    const std::string text = output_->temporary().string();
    name.resize(text.size());
    std::memcpy(name.data(), text.data(), text.size());
  });
  ranks.broadcast(name);
  const std::string text(reinterpret_cast<const char*>(name.data()), name.size());
  together(ranks, path, [&] { file_ = ranks.open_file(text); });
}

void SharedFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  assert(file_ != nullptr && offset <= bytes_ && bytes.size() <= bytes_ - offset);
  try {
    file_->write_at(offset, bytes);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw error.in_file(path_.string());
  }
}

void SharedFile::commit() {
  assert(file_ != nullptr);
  together(ranks_, path_, [&] { file_->close(); });
  file_.reset();
  together(ranks_, path_, [&] {
    if (output_ != nullptr) output_->publish();
  });
}

}  // namespace voxdag
