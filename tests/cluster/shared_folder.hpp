#pragma once
/// A temporary folder that all ranks of a test see.
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "support/temp_dir.hpp"
#include "voxdag/cluster/ranks.hpp"

namespace voxdag {

/// Rank 0 creates the folder, and removes it when all ranks destroy this. Both are collective.
class SharedFolder {
 public:
  explicit SharedFolder(Ranks& ranks) : ranks_(ranks) {
    std::vector<std::byte> name;
    if (ranks.rank() == 0) {
      dir_ = std::make_unique<TempDir>();
      const std::string text = dir_->path().string();
      name.resize(text.size());
      std::memcpy(name.data(), text.data(), text.size());
    }
    ranks.broadcast(name);
    path_ = std::string(reinterpret_cast<const char*>(name.data()), name.size());
  }
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;
  ~SharedFolder() { ranks_.barrier(); }

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  /// Creates an empty file.
  void touch(const std::string& name) const { write_text(path_ / name, ""); }
  /// Returns the number of files.
  long count() const {
    return std::distance(std::filesystem::directory_iterator(path_),
                         std::filesystem::directory_iterator());
  }

 private:
  Ranks& ranks_;
  std::unique_ptr<TempDir> dir_;
  std::filesystem::path path_;
};

}  // namespace voxdag
