#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens the first grid of floats, doubles, integers or bools, or the first mask, of an OpenVDB
/// file. Its active voxels are set; with a threshold those of them whose value is at least that. A
/// level set without a threshold sets its inside instead: all voxels with values below 0. Tiles set
/// all their voxels. Voxels are numbered from the least coordinates that are set; the transform
/// says where their centres are.
///
/// OpenVDB reads the whole file into memory, and is not made for files that one does not trust: a
/// damaged file can crash it. Its exceptions become Error. It is in a module of its own,
/// voxdag_vdb.so, which is built where OpenVDB is installed and found as shared libraries are.
/// Throws Error if there is none.
std::unique_ptr<VoxelSource> open_vdb(const std::filesystem::path& path,
                                      std::optional<double> threshold);

}  // namespace voxdag
