#pragma once
/// A folder for temporary files.
#include <sys/types.h>

#include <filesystem>

namespace voxdag {

/// Creates a folder in TMPDIR, which is removed with its contents when this object is destroyed or
/// when this process ends, even by SIGKILL.
class ScratchFolder {
 public:
  /// Throws Error if the folder cannot be made.
  ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  /// A shell that removes the folder as soon as the other end of its standard input is closed.
  pid_t remover_ = -1;
  int remover_input_ = -1;
};

}  // namespace voxdag
