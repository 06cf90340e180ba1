#include "voxdag/cluster/work_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/io/open_input.hpp"

namespace voxdag {
namespace {

constexpr const char *kJobFile = "job.json", *kLockFile = "lock";
constexpr const char* kLogFolder = "log";
/// Everything that a job writes into its folder, but its log.
constexpr const char* kJobFiles[] = {"mesh", "triangles", "parts",  "merge",
                                     "done", kJobFile,    kLockFile};
constexpr SizeLimit kJobLimit{std::uint64_t{1} << 20, "a job's settings"};

std::string json_of(const JobSettings& settings) { return nlohmann::json(settings).dump(2) + "\n"; }

/// Throws Error that names the first setting that differs.
void compare(const std::filesystem::path& folder, const std::string& text,
             const JobSettings& settings) {
  JobSettings old;
  try {
    old = nlohmann::json::parse(text).get<JobSettings>();
  } catch (const nlohmann::json::exception&) {
    throw Error((folder / kJobFile).string(), "", "is not the file of a job of voxdag");
  }
  JobSettings all = old;
  all.insert(settings.begin(), settings.end());
  for (const auto& setting : all) {
    const std::string& name = setting.first;
    const auto value_in = [&](const JobSettings& some) {
      const auto found = some.find(name);
      return found == some.end() ? "none" : found->second;
    };
    const std::string was_text = value_in(old), is_text = value_in(settings);
    if (was_text != is_text)
      throw Error(folder.string(), "",
                  "the folder belongs to a job with another " + name + ": " + was_text + ", not " +
                      is_text + "; give the same options, or another folder");
  }
}

Descriptor lock(const std::filesystem::path& folder) {
  const std::filesystem::path name = folder / kLockFile;
  Descriptor file(::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (!file.is_open())
    throw Error(folder.string(), "", "cannot write: " + std::system_category().message(errno));
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error(folder.string(), "", "another job is working in this folder");
  return file;
}

bool has_other_files(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename() != kLockFile && entry.path().filename() != kLogFolder) return true;
  return false;
}

}  // namespace

WorkFolder::WorkFolder(std::filesystem::path folder, const JobSettings& settings, bool is_owner)
    : folder_(std::move(folder)), settings_(json_of(settings)) {
  if (!is_owner) return;
  try {
    std::filesystem::create_directories(folder_);
    lock_ = lock(folder_);
    const std::filesystem::path job = folder_ / kJobFile;
    if (std::filesystem::exists(job)) {
      compare(folder_, read_input(job, kJobLimit), settings);
      return;
    }
    if (has_other_files(folder_))
      throw Error(folder_.string(), "",
                  "the folder holds other files; give an empty one, or a new name");
    remove(kLogFolder);
    write_whole_file(job, settings_);
  } catch (const std::filesystem::filesystem_error& error) {
    throw Error(folder_.string(), "", "cannot write: " + error.code().message());
  }
}

std::filesystem::path WorkFolder::file(std::string_view name) const {
  const std::filesystem::path path = folder_ / name;
  std::error_code failed;
  std::filesystem::create_directories(path.parent_path(), failed);
  return path;
}

std::uint64_t WorkFolder::key_of(std::string_view name) const {
  const std::string text = settings_ + std::string(name);
  return xxh3_64(std::as_bytes(std::span<const char>(text)));
}

WorkFileWriter WorkFolder::create(std::string_view name, std::size_t buffer_bytes) const {
  return {file(name), key_of(name), buffer_bytes};
}

std::optional<WorkFile> WorkFolder::open(std::string_view name, Work work,
                                         WorkFile::Check check) const {
  return WorkFile::open(folder_ / name, key_of(name), work, check);
}

WorkFile WorkFolder::open_written(std::string_view name, Work work) const {
  std::optional<WorkFile> file = open(name, work);
  if (!file) {
    remove(kMergeFolder);
    remove(std::filesystem::path("done").string());
    throw Error((folder_ / name).string(), "",
                "the file is missing or damaged; the same command again makes it anew");
  }
  return std::move(*file);
}

WorkFile WorkFolder::open_seen(std::string_view name, Work work) const {
  std::optional<WorkFile> file = open(name, work, WorkFile::Check::kHeader);
  if (!file)
    throw Error((folder_ / name).string(), "",
                "this rank cannot see the file that another rank wrote: all ranks need the same "
                "folder, and nobody may change it while they work");
  return std::move(*file);
}

void WorkFolder::mark_done(std::string_view step) const {
  write_whole_file(file("done/" + std::string(step)), "");
}

bool WorkFolder::is_done(std::string_view step) const {
  std::error_code unknown;
  return std::filesystem::exists(folder_ / "done" / step, unknown);
}

void WorkFolder::remove(std::string_view name) const noexcept {
  std::error_code failed;
  std::filesystem::remove_all(folder_ / name, failed);
}

void WorkFolder::remove_work() noexcept {
  for (const char* name : kJobFiles) remove(name);
}

}  // namespace voxdag
