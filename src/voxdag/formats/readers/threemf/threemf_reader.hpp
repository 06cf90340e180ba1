#pragma once
/// Reads 3MF files (3D Manufacturing Format).
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Returns whether the bytes are a ZIP archive with a part whose name has ".model".
bool is_3mf(std::string_view bytes);

/// Reads the objects that the build lists, with their components and transforms, also from other
/// models of the archive (production extension). Coordinates become millimetres, whatever the
/// file's unit; z is up. Colours: base materials and colour groups; if a triangle has several, they
/// are those of its corners. Warnings name the kinds of elements that are left out: beam lattices,
/// and with the appearance textures and other properties. Triangles of mirrored copies are turned.
///
/// Memory: the vertices and triangles of the archive's objects and those of the result. Throws
/// Error with the part and its line, OverMemory and Cancelled. Sources: 3MF Consortium, Core
/// Specification 1.3, Materials and Properties Extension 1.2, Production Extension 1.1.
MeshWithAppearance read_3mf(const MeshSource& source, ReadParts parts);

}  // namespace voxdag
