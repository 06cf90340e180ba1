#pragma once
/// A folder for temporary files.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Creates a folder in TMPDIR, and removes it with its contents when it is destroyed.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = std::filesystem::temp_directory_path() / "voxdag-bench-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) throw Error(pattern, "", "cannot make the folder");
    path_ = pattern;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace voxdag
