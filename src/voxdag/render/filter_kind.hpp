#pragma once
/// The kinds of post_filter.hpp.
#include <cstdint>

namespace voxdag {

/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010.
enum class FilterKind : std::uint8_t {
  kNone,    ///< Every voxel shows as it is.
  kNaive,   ///< Averages a disc of the pixel's own voxel: the left half of Figure 10.
  kPlain,   ///< The disc shrinks to the sizes of the voxels that it covers: Figure 11.
  kGuided,  ///< The plain filter, but it leaves out other surfaces and other light.
};

}  // namespace voxdag
