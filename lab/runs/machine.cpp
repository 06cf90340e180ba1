#include "lab/runs/machine.hpp"

#include <fmt/chrono.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "voxdag_commit.hpp"

namespace voxdag::lab {
namespace {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

/// Returns the load average of the last minute. If it is above 0 before a measurement, other
/// processes use the machine.
double load_average() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

}  // namespace

std::string program_name() {
  const std::string commit = VOXDAG_COMMIT;
  return "voxdag " VOXDAG_VERSION + (commit.empty() ? "" : " (" + commit + ")");
}

nlohmann::ordered_json machine_json() {
  struct utsname system {};
  uname(&system);
  const auto pages = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES));
  return {{"processor", processor_name()},
          {"cores", std::thread::hardware_concurrency()},
          {"memory_bytes", pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE))},
          {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
          {"time", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"load_average", load_average()}};
}

}  // namespace voxdag::lab
