#pragma once
/// The library's own mesh readers, chosen by a byte.
#include <cstdint>

#include "voxdag/formats/readers/assimp/fbx_custom.hpp"
#include "voxdag/formats/readers/collada/collada_reader.hpp"
#include "voxdag/formats/readers/gltf/gltf_reader.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/off/off_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"
#include "voxdag/formats/readers/threemf/threemf_reader.hpp"
#include "voxdag/formats/readers/used_vertices.hpp"

namespace voxdag {

/// Reads with the reader that `choice` names, and removes triangles as read_mesh() does. The
/// highest bit asks for the appearance, the second highest for an origin.
inline MeshWithAppearance read_chosen_mesh(std::uint8_t choice, MeshSource source) {
  if ((choice & 64) != 0) source.origin = {1e6, 0, -0.1};
  const auto finish = [&](MeshWithAppearance read) {
    remove_bad_triangles(source, used_vertices(source, read.mesh).bad_triangles, read);
    return read;
  };
  const ReadParts parts = choice >= 128 ? ReadParts::kMeshAndAppearance : ReadParts::kMesh;
  switch (choice % 7) {
    case 0:
      return finish(read_obj(source, parts));
    case 1:
      return finish(read_ply(source, parts));
    case 2:
      return finish(read_gltf(source, parts));
    case 3:
      return finish(read_stl(source, parts));
    case 4:
      collada_up_axis(source);
      fbx_custom(source.bytes);
      return finish(read_collada(source, parts));
    case 5:
      return finish(read_3mf(source, parts));
    default:
      return finish(read_off(source, parts));
  }
}

}  // namespace voxdag
