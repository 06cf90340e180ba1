#pragma once
/// The bytes of voxdag's own compact form.
#include "lab/runs/size_in_parts.hpp"
#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag::lab {

/// Encodes the DAG, as `voxdag convert --compact` does. Throws Cancelled.
SizeInParts voxdag_size(const SvdagView& dag, Progress& progress);

}  // namespace voxdag::lab
