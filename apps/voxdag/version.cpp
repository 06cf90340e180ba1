#include "version.hpp"

#include <hwy/targets.h>

#include "voxdag_commit.hpp"

namespace voxdag::cli {

std::string version_text() {
  const std::string commit = VOXDAG_COMMIT;
  return VOXDAG_VERSION + (commit.empty() ? "" : "\ncommit: " + commit) +
         "\nbuilt with: " VOXDAG_FEATURES "\nvector instructions: " +
         hwy::TargetName(hwy::SupportedAndGeneratedTargets().front());
}

}  // namespace voxdag::cli
