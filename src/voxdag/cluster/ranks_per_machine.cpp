#include "voxdag/cluster/ranks_per_machine.hpp"

#include <algorithm>
#include <string>

#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/io/this_process.hpp"

namespace voxdag {

RanksPerMachine ranks_per_machine(Ranks& ranks) {
  // Containers on a machine have different host names, but one boot id.
  const std::string boot = boot_id();
  const std::uint64_t machine = xxh3_64(std::as_bytes(std::span<const char>(boot)));
  const std::vector<std::uint64_t> machines = ranks.all_gather({&machine, 1});
  RanksPerMachine counts;
  for (const std::uint64_t of_rank : machines) {
    const auto ranks_there =
        static_cast<int>(std::count(machines.begin(), machines.end(), of_rank));
    counts.most = std::max(counts.most, ranks_there);
    if (of_rank == machine) counts.here = ranks_there;
  }
  return counts;
}

}  // namespace voxdag
