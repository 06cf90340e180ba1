#pragma once
/// How a texture continues outside [0,1].
#include <cstdint>

namespace voxdag {

enum class TextureWrap : std::uint8_t { kRepeat, kMirror, kClamp };

}  // namespace voxdag
