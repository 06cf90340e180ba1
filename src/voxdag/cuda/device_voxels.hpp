#pragma once
/// Voxels as the launches of kernels take them.
#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/svdag.hpp"
#include "voxdag/layout/wide_svdag.hpp"

namespace voxdag {

/// Which nodes rays are cast at.
enum class DeviceLayout { kPaper, kWide, kEsvo };

/// Pointers into the memory of a device. Of a DAG the paper's layout is always there: beams and
/// normals read it. The wide one is where rays are cast at it. Of an ESVO there is just that.
struct DeviceVoxels {
  DeviceLayout layout = DeviceLayout::kPaper;
  SvdagView paper;
  WideSvdagView wide;
  EsvoView esvo;
};

}  // namespace voxdag
