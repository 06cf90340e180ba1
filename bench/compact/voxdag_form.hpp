#pragma once
/// The bytes of voxdag's own compact form.
#include "bench/report/size_in_parts.hpp"
#include "voxdag/layout/svdag.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// Encodes the DAG, as `voxdag convert --compact` does. Throws Cancelled.
SizeInParts voxdag_size(const SvdagView& dag, Progress& progress);

}  // namespace voxdag
