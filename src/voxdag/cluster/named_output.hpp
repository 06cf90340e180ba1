#pragma once
/// An output file that other processes can open under a temporary name while it is incomplete.
#include <cstdint>
#include <filesystem>

#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {

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

}  // namespace voxdag
