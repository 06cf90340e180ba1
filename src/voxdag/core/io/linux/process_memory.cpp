#include "voxdag/core/io/process_memory.hpp"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// Memory that nothing else counts: code that is paged in after the start, small allocations and
/// the threads' stacks.
constexpr std::uint64_t kProgramBytes = std::uint64_t{6} << 20;

std::optional<std::uint64_t> read_count(const fs::path& file) {
  std::uint64_t count = 0;
  if (std::ifstream(file) >> count) return count;  // fails if the file says "max"
  return std::nullopt;
}

/// Returns the least number in the files called `name` in `folder` and the `depth` folders above
/// it.
std::optional<std::uint64_t> least_limit(fs::path folder, const char* name, std::ptrdiff_t depth) {
  std::optional<std::uint64_t> least;
  for (; depth >= 0; --depth, folder = folder.parent_path())
    if (const auto limit = read_count(folder / name); limit && (!least || *limit < *least))
      least = limit;
  return least;
}

/// Returns MemAvailable of /proc/meminfo, in bytes.
std::optional<std::uint64_t> available_bytes() {
  std::ifstream meminfo("/proc/meminfo");
  std::uint64_t kibibytes = 0;
  for (std::string line; std::getline(meminfo, line);)
    if (std::sscanf(line.c_str(), "MemAvailable: %lu", &kibibytes) == 1) return kibibytes * 1024;
  return std::nullopt;
}

}  // namespace

MemoryBudget command_budget(std::uint64_t limit) {
  // Freed memory must go back to the system, so that the counted memory is the resident memory. By
  // itself, malloc would raise these thresholds to 32 and 64 MiB.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 4 << 20);
  return MemoryBudget(limit != 0 ? limit : default_memory_limit(),
                      resident_bytes() + kProgramBytes);
}

std::uint64_t default_memory_limit() {
  const auto available = available_bytes(), allowed = cgroup_memory_limit();
  if (!available && !allowed) return 0;
  const std::uint64_t least =
      std::min(available.value_or(~std::uint64_t{0}), allowed.value_or(~std::uint64_t{0}));
  return std::max<std::uint64_t>(1, least / 4 * 3);
}

std::optional<std::uint64_t> cgroup_memory_limit(const fs::path& root) {
  // Lines "NUMBER:CONTROLLERS:/PATH"; version 2 names no controllers.
  std::ifstream groups(root / "proc/self/cgroup");
  std::optional<std::uint64_t> least;
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    std::string controllers(1, ',');
    controllers += line.substr(first + 1, second - first - 1);
    controllers += ',';
    const fs::path group = fs::path(line.substr(second + 1)).relative_path().lexically_normal();
    const bool version_2 = controllers == ",,";
    if (!version_2 && controllers.find(",memory,") == std::string::npos) continue;
    const fs::path top = root / "sys/fs/cgroup" / (version_2 ? "" : "memory");
    const auto depth =
        group.empty() || group == "." ? 0 : std::distance(group.begin(), group.end());
    const auto limit = least_limit(depth == 0 ? top : top / group,
                                   version_2 ? "memory.max" : "memory.limit_in_bytes", depth);
    if (limit && (!least || *limit < *least)) least = limit;
  }
  return least;
}

std::uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  if (!(statm >> total >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_resident_bytes() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace voxdag
