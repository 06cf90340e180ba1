#pragma once
/// Runs of the report that do not depend on one another, so that several processes can share them.
#include <functional>

namespace voxdag::lab {

/// Runs cells. It returns nothing: whoever runs these cells later finds their results kept. It
/// throws Error and Cancelled.
using RunItem = std::function<void()>;

}  // namespace voxdag::lab
