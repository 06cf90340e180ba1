#include "voxdag/core/io/temporary_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// The maximum bytes of NAME. It leaves room for the suffix, because file systems allow 255 bytes
/// for a name.
constexpr std::size_t kMaxStem = 200;
constexpr std::string_view kMark = ".voxdag-";
constexpr std::string_view kLockTest = ".locktest.";

std::string prefix_of(const fs::path& target) {
  return target.filename().string().substr(0, kMaxStem) + std::string(kMark);
}

/// Parses decimal digits without sign or leading zero. Returns -1 for anything else.
long parse_digits(std::string_view digits) {
  long value = -1;
  if (digits.empty() || (digits[0] == '0' && digits.size() > 1) || digits[0] == '-') return -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() && end == digits.data() + digits.size() ? value : -1;
}

/// Returns the name without the suffix `.locktest.RANK`. While Open MPI opens a file, it makes a
/// second file with this suffix, to find out whether the file system has locks.
std::string_view without_lock_test(std::string_view name) {
  const std::size_t at = name.find(kLockTest);
  return at != name.npos && parse_digits(name.substr(at + kLockTest.size())) >= 0
             ? name.substr(0, at)
             : name;
}

/// Returns the process id in a name that temporary_name() makes from `prefix`, also with the suffix
/// `.locktest.RANK`, or -1.
long process_of(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return -1;
  name.remove_prefix(prefix.size());
  name = without_lock_test(name);
  const std::size_t dash = name.find('-');
  if (dash == name.npos || parse_digits(name.substr(dash + 1)) < 0) return -1;
  return parse_digits(name.substr(0, dash));
}

bool is_running(long process) {
  return process <= 0 || ::kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH;
}

/// Removes the file unless a process holds its lock.
void remove_unlocked(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat info {};
  if (!file.is_open() || ::fstat(file.get(), &info) != 0) return;
  if (!S_ISREG(info.st_mode) || info.st_uid != ::geteuid() || info.st_nlink != 1) return;
  if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
}

/// Returns the names in a folder that contain the mark of temporary files. Caches them per folder,
/// because one run can write many files into one large folder.
std::vector<std::string> marked_names(const fs::path& folder) {
  static std::mutex mutex;
  static std::map<fs::path, std::vector<std::string>> known;
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = known.try_emplace(folder);
  if (is_new)
    for (const fs::directory_entry& file : fs::directory_iterator(folder))
      if (const std::string name = file.path().filename(); name.find(kMark) != name.npos)
        entry->second.push_back(name);
  return entry->second;
}

}  // namespace

fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> serial{0};
  return target.parent_path() /
         (prefix_of(target) + std::to_string(getpid()) + "-" + std::to_string(serial++));
}

void lock_temporary(int descriptor) noexcept { ::flock(descriptor, LOCK_EX | LOCK_NB); }

void remove_leftovers(const fs::path& target) noexcept {
  try {
    const fs::path folder = fs::absolute(target).parent_path();
    const std::string prefix = prefix_of(target);
    for (const std::string& name : marked_names(folder))
      if (!is_running(process_of(name, prefix))) remove_unlocked(folder / name);
  } catch (const std::exception&) {  // The folder cannot be listed: nothing is removed.
  }
}

}  // namespace voxdag
