#pragma once
/// Joins the meshes of several files, and numbers their triangles by file or object.
#include <span>
#include <string>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Prepares a mesh for append_mesh(): gives it the material and the object `name` if it has none,
/// and puts "name/" before the names of its objects. Reserves the added bytes in `memory`. Throws
/// OverMemory.
void name_parts(MeshWithAppearance& source, const std::string& name, MemoryBudget* memory);

/// Appends a mesh. Both must have passed name_parts(), and both or neither must have an appearance.
/// Corners without a normal, a texture coordinate or a colour get unset ones. memory_bytes() of
/// both must be reserved in `memory`; the function reserves those of the result instead. Throws
/// Error if the result has too many vertices or triangles, and OverMemory.
void append_mesh(MeshWithAppearance& to, MeshWithAppearance from, MemoryBudget* memory);

/// Returns the object of each of `triangles` triangles. The first run begins at triangle 0. Throws
/// OverMemory.
CountedVector<std::uint32_t> ids_of_runs(std::span<const ObjectRun> runs, std::uint64_t triangles,
                                         MemoryBudget* memory);

}  // namespace voxdag
