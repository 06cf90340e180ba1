#pragma once
/// Sorts any number of 64-bit codes in bounded memory.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/io/descriptor.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// Collects codes. Sorts those that fit into memory, and writes them to a file without a name as a
/// run. The result does not depend on the memory.
class SortedCodes {
 public:
  /// Holds `capacity` codes (at least 1024 are held) and sorts them in the same memory. Files lie
  /// in `folder`; there are none as long as all codes fit. `memory`, which may be null, counts the
  /// codes. Throws OverMemory.
  SortedCodes(std::size_t capacity, std::filesystem::path folder, MemoryBudget* memory,
              Progress* progress);

  /// Adds a code; the same one may be added again. Throws Error if a file cannot be written, and
  /// Cancelled.
  void add(std::uint64_t code) {
    if (codes_.size() == capacity_) spill();
    codes_.push_back(code);
  }
  /// Calls visit(code) for all different codes in ascending order, once. Call it last. Throws what
  /// `visit` throws, Error if a file cannot be read, and Cancelled.
  void visit_all(const std::function<void(std::uint64_t)>& visit);

  /// Returns the number of runs that were written to files.
  std::size_t runs() const { return runs_.size(); }

 private:
  struct Run {
    Descriptor file;
    std::uint64_t codes = 0;
  };
  class RunReader;

  void sort_in_memory();
  void spill();

  std::size_t capacity_;
  std::filesystem::path folder_;
  Progress* progress_;
  PageVector<std::uint64_t> codes_;
  std::vector<Run> runs_;
};

}  // namespace voxdag
