#pragma once
/// A large array in files of the work folder.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// The files NAME-0, NAME-1, ... that ranks have written, as one array, mapped into memory.
template <class T>
class ArrayFiles {
 public:
  /// Opens `count` files. Throws Error if one is missing, and Cancelled.
  ArrayFiles(const WorkFolder& folder, const std::string& name, std::uint64_t count, Work work) {
    for (std::uint64_t i = 0; i < count; ++i) {
      files_.push_back(folder.open_seen(numbered_name(name, i), work));
      firsts_.push_back(firsts_.back() + files_.back().values<T>().size());
    }
  }

  std::uint64_t size() const { return firsts_.back(); }

  /// Reads elements with indices below size(); fast if they are near each other. For one thread.
  class Reader {
   public:
    explicit Reader(const ArrayFiles& array) : array_(array) {}
    const T& operator[](std::uint64_t index) {
      if (index - first_ >= run_.size()) {
        const auto file = static_cast<std::size_t>(
            std::upper_bound(array_.firsts_.begin(), array_.firsts_.end(), index) -
            array_.firsts_.begin() - 1);
        first_ = array_.firsts_[file];
        run_ = array_.files_[file].template values<T>();
      }
      return run_[index - first_];
    }

   private:
    const ArrayFiles& array_;
    std::uint64_t first_ = 0;  ///< Index of the first element of `run_`.
    std::span<const T> run_;
  };

  /// Drops the pages of all files from this process's memory. Thread-safe.
  void release() const {
    for (const WorkFile& file : files_) file.release(file.bytes().size());
  }

 private:
  std::vector<WorkFile> files_;
  std::vector<std::uint64_t> firsts_{0};  ///< First element of each file, and number of all.
};

}  // namespace voxdag
