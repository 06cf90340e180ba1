#pragma once
/// The materials of an OBJ file, from the MTL files that it names.
#include <string>
#include <vector>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/name_table.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Fills appearance.materials from the MTL files that the `mtllib` statements with the arguments
/// `libraries` name. Materials that no file describes are grey. Returns the warnings. Throws
/// OverMemory and Cancelled.
std::vector<std::string> read_obj_materials(const MeshSource& source, const Mesh& mesh,
                                            const NameTable& libraries, std::size_t bad_references,
                                            Appearance& appearance);

/// Adds the MTL files to ReadOptions::named_files without opening them.
void report_obj_libraries(const MeshSource& source, const NameTable& libraries);

}  // namespace voxdag
