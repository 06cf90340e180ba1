#include "voxdag/cluster/parts_log.hpp"

#include <fmt/core.h>

#include "voxdag/core/io/process_memory.hpp"

namespace voxdag {

PartsLog::PartsLog(const WorkFolder& folder, int rank)
    : file_(folder.file("log/rank-" + std::to_string(rank) + ".jsonl"), std::ios::app),
      rank_(rank) {}

void PartsLog::part(Start start, std::uint64_t part, std::uint64_t triangles, std::uint64_t pieces,
                    std::uint64_t bytes) {
  const double seconds = std::chrono::duration<double>(PartsLog::start() - start).count();
  file_
      << fmt::format(
             R"({{"part": {}, "rank": {}, "seconds": {:.3f}, "triangles": {}, "pieces": {}, "file_bytes": {}, "resident_bytes": {}, "peak_bytes": {}}})",
             part, rank_, seconds, triangles, pieces, bytes, resident_bytes(),
             peak_resident_bytes())
      << std::endl;
}

}  // namespace voxdag
