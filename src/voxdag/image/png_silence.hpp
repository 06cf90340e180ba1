#pragma once
/// Keeps libpng from printing warnings.
#include <png.h>

namespace voxdag {

inline void ignore_warning(png_structp, png_const_charp) {}

}  // namespace voxdag
