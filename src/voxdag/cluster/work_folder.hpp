#pragma once
/// The folder in which a job keeps what it has done.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "voxdag/cluster/work_file.hpp"
#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// The settings that decide the output of a job, by name: "resolution": "8192". A job with other
/// settings cannot use its folder.
using JobSettings = std::map<std::string, std::string>;

/// Returns the name of one of many files: NAME-NUMBER.
inline std::string numbered_name(std::string_view name, std::uint64_t number) {
  return std::string(name) + "-" + std::to_string(number);
}

class WorkFolder {
 public:
  /// Opens the folder, or creates it. Throws Error with the folder's name if it cannot be written,
  /// holds other files, is in use, or belongs to a job with other settings; the reason names the
  /// first setting that differs. Rank 0 calls it first, with `is_owner`.
  WorkFolder(std::filesystem::path folder, const JobSettings& settings, bool is_owner);

  const std::filesystem::path& path() const { return folder_; }
  /// Returns the path of a file; makes its folder.
  std::filesystem::path file(std::string_view name) const;

  /// Begins a file of the job. Throws Error.
  WorkFileWriter create(std::string_view name,
                        std::size_t buffer_bytes = WorkFileWriter::kBufferBytes) const;
  /// Opens a file of the job; see WorkFile::open().
  std::optional<WorkFile> open(std::string_view name, Work work,
                               WorkFile::Check check = WorkFile::Check::kAll) const;
  /// Opens a file that the job has written. Throws Error if it is missing or damaged, and removes
  /// the folder of unfinished merges, so that the next run makes it again from the parts.
  WorkFile open_written(std::string_view name, Work work) const;

  /// Opens a file that a rank has written or checked in this run; trusts its contents. Throws Error
  /// if this rank cannot see it.
  WorkFile open_seen(std::string_view name, Work work) const;

  /// Writes an empty file that says that a step is done, and asks for it.
  void mark_done(std::string_view step) const;
  bool is_done(std::string_view step) const;

  /// Removes a file or a folder; nothing happens if there is none.
  void remove(std::string_view name) const noexcept;
  /// Removes everything that the job wrote, but its log.
  void remove_work() noexcept;

 private:
  std::uint64_t key_of(std::string_view name) const;

  std::filesystem::path folder_;
  std::string settings_;  ///< The text of job.json.
  Descriptor lock_;
};

/// The folder of merges and numbering, within the work folder.
inline constexpr std::string_view kMergeFolder = "merge";

}  // namespace voxdag
