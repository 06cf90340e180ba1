#pragma once
/// How many ranks of a job share a machine.
#include "voxdag/cluster/ranks.hpp"

namespace voxdag {

struct RanksPerMachine {
  int here = 1;  ///< On the machine of this rank.
  int most = 1;  ///< On the machine that has most of them; equal on all ranks.
};

/// Counts the ranks that run under one kernel. Collective.
RanksPerMachine ranks_per_machine(Ranks& ranks);

}  // namespace voxdag
