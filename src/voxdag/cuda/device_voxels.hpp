#pragma once
/// Voxels as arguments of kernel launches.
#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/svdag/svdag.hpp"
#include "voxdag/stored/svdag/top_grid.hpp"

namespace voxdag {

/// The node layout for rays: kPaper or kTop (with a dense grid above it) for a DAG, kContours or
/// kCubes (the voxels without their contours) for an ESVO.
enum class DeviceLayout { kPaper, kTop, kContours, kCubes };

/// Pointers into the memory of a device. A DAG always has the paper's layout, which beams and
/// normals read. It has a grid only if rays use it. An ESVO has only its own layout.
struct DeviceVoxels {
  DeviceLayout layout = DeviceLayout::kPaper;
  SvdagView paper;
  TopGridView top;
  EsvoView esvo;
};

}  // namespace voxdag
