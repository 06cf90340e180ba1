#pragma once
/// The presentation of a scene by the custom of its input's format.
#include "voxdag/file/scene_metadata.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag {

/// Returns the up axis and the unit of an input after its move, as far as they are known.
inline Presentation presentation_of(const TransformRequest& move, const FormatCustom& custom) {
  const FormatCustom moved = custom_after(move, custom);
  Presentation presentation;
  if (moved.has_up) presentation.up = static_cast<char>('x' + moved.up);
  presentation.unit = moved.unit;
  return presentation;
}

}  // namespace voxdag
