#pragma once
/// The up axis and the unit of an FBX file, which assimp ignores.
#include <string_view>

#include "voxdag/mesh/input_transform.hpp"

namespace voxdag {

/// Returns what the file's global settings say, text or binary; y and centimetres if they say
/// nothing. Units that TransformRequest has no name for give none.
FormatCustom fbx_custom(std::string_view bytes);

}  // namespace voxdag
