#pragma once
/// A DAG as the launches of kernels take it.
#include "voxdag/layout/svdag.hpp"
#include "voxdag/layout/wide_svdag.hpp"

namespace voxdag {

/// Which nodes rays are cast at.
enum class DeviceLayout { kPaper, kWide };

/// Pointers into the memory of a device. The paper's layout is always there: beams and normals read
/// it. The wide one is where rays are cast at it.
struct DeviceDag {
  DeviceLayout layout = DeviceLayout::kPaper;
  SvdagView paper;
  WideSvdagView wide;
};

}  // namespace voxdag
