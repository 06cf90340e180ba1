#pragma once
/// tinybvh: casts voxdag's rays, one at a time, at the triangles of the mesh.
#include <memory>

#include "lab/rivals/rival.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag::lab {

/// Returns a rival whose casts are "tinybvh" (BVH8_CPU) and "tinybvh_hq" (BVH8_CPU with spatial
/// splits). Returns null if voxdag-lab was built without tinybvh (VOXDAG_TINYBVH_DIR), if the
/// processor lacks AVX2, or if the mesh has no triangles.
std::unique_ptr<Rival> make_tinybvh_rival(const Mesh& mesh);

}  // namespace voxdag::lab
