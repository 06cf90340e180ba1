#pragma once
/// Voxels as arguments of kernel launches.
#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/svdag.hpp"
#include "voxdag/layout/wide_svdag.hpp"

namespace voxdag {

/// The node layout at which rays are cast.
enum class DeviceLayout { kPaper, kWide, kEsvo };

/// Pointers into the memory of a device. A DAG always has the paper's layout, which beams and
/// normals read, and the wide one only if rays are cast at it. An ESVO has only its own.
struct DeviceVoxels {
  DeviceLayout layout = DeviceLayout::kPaper;
  SvdagView paper;
  WideSvdagView wide;
  EsvoView esvo;
};

}  // namespace voxdag
