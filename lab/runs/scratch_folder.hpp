#pragma once
/// A folder for temporary files.
#include <sys/types.h>

#include <filesystem>

namespace voxdag::lab {

/// Creates a folder in another one, by default in TMPDIR. It is removed with its contents when this
/// object is destroyed or when this process ends, even by SIGKILL.
class ScratchFolder {
 public:
  /// Throws Error if the folder cannot be made.
  explicit ScratchFolder(
      const std::filesystem::path& parent = std::filesystem::temp_directory_path());
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  /// Ends the keeper and waits until it has removed the folder.
  void end_keeper();

  std::filesystem::path path_;
  /// A shell that creates the folder, and removes it as soon as its standard input ends: when the
  /// other end of that pipe is closed, by this object or because this process ended.
  pid_t keeper_ = -1;
  int keeper_input_ = -1;
};

}  // namespace voxdag::lab
