#pragma once
/// The claims of the SVDAG paper, each with what was measured here.
#include <optional>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/svdag/flight.hpp"
#include "lab/reproduce/svdag/svdag_builds.hpp"

namespace voxdag::lab {

/// Returns a table with a line for each claim: reproduced, exceeded, not reproduced, or not
/// measured. Claims about sizes and times look at the paper's scenes and their variants only.
Section svdag_claims_section(const std::vector<SvdagSceneBuilds>& scenes,
                             const std::optional<Flight>& flight);

}  // namespace voxdag::lab
