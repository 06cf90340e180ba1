#pragma once
/// Makes the files that a job's folder lacks, shared among the ranks.
#include <cstdint>
#include <functional>
#include <string>

#include "voxdag/cluster/ranks.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {

/// The shared counters (Ranks::next) from which the steps of a job take their tasks.
enum JobCounter : int {
  kMeshCountsCounter,
  kMeshVerticesCounter,
  kMeshTrianglesCounter,
  kSegmentCounter,
  kPartCounter
};

/// The numbered files of one step.
struct StepFiles {
  JobCounter counter;  ///< Gives the numbers to the ranks.
  std::uint64_t count;
  std::function<std::string(std::uint64_t number)> name;  ///< Within the folder.
  const char* stage;                                      ///< For the progress.
  WorkFile::Check check = WorkFile::Check::kAll;
};

/// Calls make(number) for the files from 0 to count - 1 that are missing or damaged; it must write
/// the file. Each rank takes one number after the other. Waits until all files are there.
/// Collective. Throws Cancelled and what make() throws.
template <class Make>
void make_missing(Ranks& ranks, const WorkFolder& folder, const StepFiles& files, Work work,
                  const Make& make) {
  ranks.reset(files.counter);
  for (std::uint64_t number; (number = ranks.next(files.counter)) < files.count;) {
    work.poll();
    work.report_done(files.stage, number, files.count);
    if (!folder.open(files.name(number), work, files.check)) make(number);
  }
  ranks.barrier();
}

}  // namespace voxdag
