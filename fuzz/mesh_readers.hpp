#pragma once
/// The library's own mesh readers, chosen by a byte.
#include <cstdint>

#include "voxdag/formats/readers/collada/collada_reader.hpp"
#include "voxdag/formats/readers/gltf/gltf_reader.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/off/off_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"
#include "voxdag/formats/readers/threemf/threemf_reader.hpp"

namespace voxdag {

/// Reads with the reader that `choice` names; its highest bit asks for the appearance.
inline MeshWithAppearance read_chosen_mesh(std::uint8_t choice, const MeshSource& source) {
  const ReadParts parts = choice >= 128 ? ReadParts::kMeshAndAppearance : ReadParts::kMesh;
  switch (choice % 7) {
    case 0:
      return read_obj(source, parts);
    case 1:
      return read_ply(source, parts);
    case 2:
      return read_gltf(source, parts);
    case 3:
      return {read_stl(source), {}, {}};
    case 4:
      return read_collada(source, parts);
    case 5:
      return read_3mf(source, parts);
    default:
      return {read_off(source), {}, {}};
  }
}

}  // namespace voxdag
