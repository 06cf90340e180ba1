#pragma once
/// An output folder that appears under its name only when it is complete.
#include <filesystem>

namespace voxdag {

/// Creates an empty folder beside the target. take_name() gives it the target's name. The
/// destructor removes the folder if it has not taken the name, also after an exception. A killed
/// process leaves NAME.voxdag-PID-N.
class TemporaryFolder {
 public:
  /// Throws Error, which names the target, if the folder cannot be created.
  explicit TemporaryFolder(const std::filesystem::path& target);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

  /// Replaces a folder that has the target's name, at once: no moment is without a folder. Throws
  /// Error.
  void take_name() const;

 private:
  std::filesystem::path target_, path_;
};

}  // namespace voxdag
