#pragma once
/// Reads COLLADA files (.dae).
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Reads the triangles, polygons, strips and fans of the scene, with the transforms of its nodes.
/// Coordinates become metres, as the file's unit says; the axes stay as they are. Meshes with bones
/// are read in their bind pose, morphed meshes in their base shape. Colours: the diffuse and
/// emitted colours of the materials. Warnings say once each that holes of polygons, splines, bones,
/// and with the appearance textures and colours of vertices, are left out. Triangles of mirrored
/// copies are turned.
///
/// Memory: about that of the file, its numbers and the result. Throws Error with the line or the
/// element, OverMemory and Cancelled. Source: Khronos Group, COLLADA 1.4.1 and 1.5 Specifications.
MeshWithAppearance read_collada(const MeshSource& source, ReadParts parts);

/// Returns the axis that points up: 0 (x), 1 (y, also where the file does not say it) or 2 (z).
/// Reads the file as far as it says so. Throws Error with the line if that is no XML.
int collada_up_axis(const MeshSource& source);

}  // namespace voxdag
