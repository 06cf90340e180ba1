#pragma once
/// Exports the outer faces of voxels as meshes: GLB, OBJ, STL and 3MF.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes the outer faces of the voxels of the window, counter-clockwise from outside, as a binary
/// glTF file. Faces of one plane, and with a look of one colour, are merged to rectangles
/// (rectangles.hpp) of two triangles each. Coordinates are in world units, as float, if that is
/// exact to 1/16 voxel over the whole grid; otherwise they are voxels from window.lo, and the
/// node's scale and translation place them in the world. Colours are COLOR_0, linear, 16 bits.
/// Throws Error, before it writes, if the file would have more than 2^32 - 1 bytes. Source: Khronos
/// Group, glTF 2.0 Specification.
void export_glb(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

/// Writes the triangles of export_glb() as an OBJ file, in world units. Colours, sRGB
/// encoded from 0 to 1, follow the coordinates of each corner, as many programs read them.
void export_obj(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

/// Writes two triangles for each outer face as a binary STL file, in world units. Faces are not
/// merged, so that each edge belongs to an even number of triangles, in equal numbers in both
/// directions: the mesh is closed. STL has no colours. Throws Error, before it writes, if the file
/// would have more than 2^32 - 1 triangles, or if float coordinates are not exact to 1/16 voxel.
void export_stl(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

/// Writes the outer faces as a 3MF file with one object, a manifold or a smooth one
/// (options.faces), whose triangles share their vertices. Coordinates are world units:
/// options.unit, which 3MF takes for millimetres if it is empty. Colours are a colour group, which
/// triangles refer to. Throws Error, before it writes, if there are no voxels, or more than 2^31 -
/// 1 vertices. Sources: 3MF Consortium, Core Specification 1.3, Materials and Properties
/// Extension 1.2.
void export_3mf(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

}  // namespace voxdag
