#pragma once
/// An output folder that appears under its name only when it is complete.
#include <filesystem>

namespace voxdag {

/// Files are written to inside(), a folder beside the output. commit() gives it the output's name.
/// If it is destroyed before, it removes the folder. A killed process leaves NAME.voxdag-PID.
class NewFolder {
 public:
  /// Creates the folder. Throws Error if `path` exists and is not an empty folder, or if the folder
  /// cannot be created.
  explicit NewFolder(const std::filesystem::path& path);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const std::filesystem::path& inside() const { return temporary_; }
  /// Throws Error if the folder cannot be renamed.
  void commit();

 private:
  std::filesystem::path path_, temporary_;
};

}  // namespace voxdag
