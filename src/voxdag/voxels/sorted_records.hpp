#pragma once
/// Sorts any number of records in bounded memory.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <queue>
#include <type_traits>
#include <utility>
#include <vector>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/parallel/polled_for.hpp"
#include "voxdag/parallel/polled_sort.hpp"
#include "voxdag/voxels/run_file.hpp"

namespace voxdag {

enum class Repeats { kKept, kDropped };

/// Collects records of a plain type with < and ==. Sorts those that fit into memory, and writes
/// them to a file without a name as a run. The result does not depend on the memory.
template <class Record, Repeats kRepeats>
class SortedRecords {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  /// Holds `capacity` records (at least 1024 are held) and sorts them in the same memory. Files lie
  /// in `folder`; there are none as long as all records fit. `memory`, which may be null, counts
  /// the records. Throws OverMemory.
  SortedRecords(std::size_t capacity, std::filesystem::path folder, MemoryBudget* memory,
                Progress* progress)
      : capacity_(std::max(capacity, kLeastCapacity)),
        folder_(std::move(folder)),
        progress_(progress),
        records_(memory) {}

  /// Adds a record. Throws Error if a file cannot be written, OverMemory and Cancelled.
  void add(const Record& record) {
    if (records_.size() == capacity_) spill();
    records_.push_back(record);
    is_sorted_ = false;
  }
  /// Calls visit(record) for all records in ascending order; equal ones once if repeats are
  /// dropped. Throws what `visit` throws, Error if a file cannot be read, and Cancelled.
  template <class Visit>
  void visit_all(const Visit& visit);

  /// Returns the number of runs that were written to files.
  std::size_t runs() const { return runs_.size(); }

 private:
  struct Run {
    RunFile file;
    std::uint64_t records = 0;
  };
  class RunReader;

  static constexpr std::size_t kLeastCapacity = 1024;

  void sort_in_memory() {
    if (is_sorted_) return;
    polled_sort(records_.begin(), records_.end(), progress_);
    if constexpr (kRepeats == Repeats::kDropped)
      records_.resize(static_cast<std::size_t>(std::unique(records_.begin(), records_.end()) -
                                               records_.begin()));
    is_sorted_ = true;
  }
  void spill() {
    sort_in_memory();
    // Many equal records may have made room.
    if (records_.size() <= capacity_ / 2) return;
    Run run{RunFile(folder_), records_.size()};
    run.file.write(records_.data(), records_.size() * sizeof(Record), progress_);
    runs_.push_back(std::move(run));
    records_.resize(0);
  }

  std::size_t capacity_;
  std::filesystem::path folder_;
  Progress* progress_;
  PageVector<Record> records_;
  bool is_sorted_ = true;
  std::vector<Run> runs_;
};

/// Reads a run from its beginning.
template <class Record, Repeats kRepeats>
class SortedRecords<Record, kRepeats>::RunReader {
 public:
  explicit RunReader(const Run& run) : run_(run) { read(); }
  bool is_at_end() const { return at_ == records_.size(); }
  const Record& record() const { return records_[at_]; }
  void next() {
    if (++at_ == records_.size()) read();
  }

 private:
  static constexpr std::size_t kReadBytes = std::size_t{1} << 18;

  void read() {
    at_ = 0;
    records_.resize(static_cast<std::size_t>(
        std::min<std::uint64_t>(kReadBytes / sizeof(Record), run_.records - done_)));
    run_.file.read(records_.data(), records_.size() * sizeof(Record), done_ * sizeof(Record));
    done_ += records_.size();
  }

  const Run& run_;
  std::vector<Record> records_;
  std::size_t at_ = 0;
  std::uint64_t done_ = 0;
};

template <class Record, Repeats kRepeats>
template <class Visit>
void SortedRecords<Record, kRepeats>::visit_all(const Visit& visit) {
  sort_in_memory();
  if (runs_.empty()) {
    for (std::size_t i = 0; i < records_.size(); ++i) {
      poll_seldom(progress_, i);
      visit(records_[i]);
    }
    return;
  }
  std::vector<RunReader> readers;
  readers.reserve(runs_.size());
  for (const Run& run : runs_) readers.emplace_back(run);
  // The records of memory come last. Returns the next record of a source, null at its end.
  std::size_t in_memory = 0;
  const auto head = [&](std::size_t source) -> const Record* {
    if (source == readers.size())
      return in_memory < records_.size() ? &records_[in_memory] : nullptr;
    return readers[source].is_at_end() ? nullptr : &readers[source].record();
  };
  const auto advance = [&](std::size_t source) {
    if (source == readers.size())
      ++in_memory;
    else
      readers[source].next();
  };
  using Head = std::pair<Record, std::size_t>;
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
  for (std::size_t i = 0; i <= readers.size(); ++i)
    if (const Record* record = head(i)) heads.emplace(*record, i);
  bool is_first = true;
  Record last{};
  std::uint64_t polled = 0;
  while (!heads.empty()) {
    const std::size_t source = heads.top().second;
    heads.pop();
    // Runs of data in some order hardly overlap: stay with a source while it is the least.
    const Record* record = head(source);
    do {
      poll_seldom(progress_, polled++);
      if (kRepeats == Repeats::kKept || is_first || !(*record == last)) visit(*record);
      is_first = false;
      last = *record;
      advance(source);
      record = head(source);
    } while (record != nullptr && (heads.empty() || !(heads.top().first < *record)));
    if (record != nullptr) heads.emplace(*record, source);
  }
}

}  // namespace voxdag
