#pragma once
/// Sorts any number of records in bounded memory.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <queue>
#include <type_traits>
#include <utility>
#include <vector>

#include "voxdag/algebra/voxels/run_file.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"

namespace voxdag {

enum class Repeats { kKept, kDropped };

/// Collects records of a plain type with < and ==. Sorts those that fit into memory, and writes
/// them to a file without a name as a run. The result does not depend on the memory.
template <class Record, Repeats kRepeats>
class SortedRecords {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  /// Holds `capacity` records (at least 1024 are held) and sorts them in the same memory. The file
  /// of the other records lies in `folder`; there is none as long as all records fit. `work` counts
  /// the records and the buffers that the file is read through. Throws OverMemory.
  SortedRecords(std::size_t capacity, std::filesystem::path folder, Work work)
      : capacity_(std::max(capacity, kMinCapacity)),
        folder_(std::move(folder)),
        work_(work),
        records_(work.memory) {}

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

  /// Returns the number of runs that were written to the file.
  std::size_t runs() const { return runs_.size(); }

 private:
  /// Sorted records in the file, from this byte on.
  struct Run {
    std::uint64_t begin, records;
  };
  class RunReader;

  static constexpr std::size_t kMinCapacity = 1024;

  void sort_in_memory() {
    if (is_sorted_) return;
    polled_sort(records_.begin(), records_.end(), work_);
    if constexpr (kRepeats == Repeats::kDropped)
      records_.resize(static_cast<std::size_t>(std::unique(records_.begin(), records_.end()) -
                                               records_.begin()));
    is_sorted_ = true;
  }
  void spill() {
    sort_in_memory();
    // Many equal records may have made room.
    if (records_.size() <= capacity_ / 2) return;
    write_run();
  }
  /// Writes the records in memory, which must be sorted, as a run.
  void write_run() {
    if (!file_) file_.emplace(folder_);
    const std::uint64_t begin =
        runs_.empty() ? 0 : runs_.back().begin + runs_.back().records * sizeof(Record);
    file_->write(records_.data(), records_.size() * sizeof(Record), work_);
    runs_.push_back({begin, records_.size()});
    records_.clear();
  }

  std::size_t capacity_;
  std::filesystem::path folder_;
  Work work_;
  PageVector<Record> records_;
  bool is_sorted_ = true;
  std::optional<RunFile> file_;
  std::vector<Run> runs_;
};

/// Reads a run from its beginning.
template <class Record, Repeats kRepeats>
class SortedRecords<Record, kRepeats>::RunReader {
 public:
  /// Reads up to `most` records at a time.
  RunReader(const RunFile& file, const Run& run, std::size_t most)
      : file_(file), run_(run), most_(most) {
    read();
  }
  bool is_at_end() const { return at_ == records_.size(); }
  const Record& record() const { return records_[at_]; }
  void next() {
    if (++at_ == records_.size()) read();
  }

 private:
  void read() {
    at_ = 0;
    records_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most_, run_.records - done_)));
    file_.read(records_.data(), records_.size() * sizeof(Record),
               run_.begin + done_ * sizeof(Record));
    done_ += records_.size();
  }

  const RunFile& file_;
  const Run& run_;
  std::size_t most_;
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
      work_.poll_seldom(i);
      visit(records_[i]);
    }
    return;
  }
  // The buffers of the readers take the place of the records in memory.
  if (!records_.empty()) write_run();
  records_.release();
  constexpr std::size_t kMin = 4096 / sizeof(Record),
                        kMax = (std::size_t{1} << 18) / sizeof(Record);
  const std::size_t buffer = std::clamp(capacity_ / runs_.size(), kMin, kMax);
  const MemoryReservation buffers(work_.memory, runs_.size() * buffer * sizeof(Record));
  std::vector<RunReader> readers;
  readers.reserve(runs_.size());
  for (const Run& run : runs_) readers.emplace_back(*file_, run, buffer);
  using Head = std::pair<Record, std::size_t>;
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
  for (std::size_t i = 0; i < readers.size(); ++i)
    if (!readers[i].is_at_end()) heads.emplace(readers[i].record(), i);
  bool is_first = true;
  Record last{};
  std::uint64_t polled = 0;
  while (!heads.empty()) {
    const std::size_t source = heads.top().second;
    RunReader& reader = readers[source];
    heads.pop();
    // Runs hardly overlap if the data came in some order: stay with a run while its record is the
    // least.
    do {
      work_.poll_seldom(polled++);
      const Record& record = reader.record();
      if (kRepeats == Repeats::kKept || is_first || !(record == last)) visit(record);
      is_first = false;
      last = record;
      reader.next();
    } while (!reader.is_at_end() && (heads.empty() || !(heads.top().first < reader.record())));
    if (!reader.is_at_end()) heads.emplace(reader.record(), source);
  }
}

}  // namespace voxdag
