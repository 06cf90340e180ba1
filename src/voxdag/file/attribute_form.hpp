#pragma once
/// How a .vdag file stores colours, normals and material ids.

namespace voxdag {

enum class AttributeForm {
  kPages,  ///< With random access.
  kWire,   ///< A quarter smaller or more, but a reader decodes all of them (wire_chunks.hpp).
};

}  // namespace voxdag
