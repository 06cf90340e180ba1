#pragma once
/// The size of a picture.

namespace voxdag {

struct ImageSize {
  int width = 0, height = 0;  ///< Pixels.
};

}  // namespace voxdag
