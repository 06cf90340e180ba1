#pragma once
/// Opens files of volumes. `threshold`: values that are at least this set their voxel; without it,
/// all values other than 0 do. `labels`: without a field. `channels`: at most one, of the field
/// "value".
#include <string_view>

#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens a grid of voxels, run-length encoded (Patrick Min, "binvox").
std::unique_ptr<VoxelSource> open_binvox(const std::filesystem::path& path);

/// Opens a volume of NIfTI-1 or NIfTI-2 in one file, also compressed with gzip: integers, float32,
/// float64, RGB24 and RGBA32. A threshold is compared with the scaled values (scl_slope and
/// scl_inter). An RGBA voxel is set by its alpha, an RGB voxel by the greatest of its channels. Of
/// a file with several volumes only the first one is read. The place comes from the sform, else
/// from the qform; both hold centres of voxels. Lengths are in the unit of the file.
std::unique_ptr<VoxelSource> open_nifti(const std::filesystem::path& path,
                                        std::optional<double> threshold,
                                        const LabelRequest& labels = {},
                                        const std::vector<ChannelRequest>& channels = {});

/// Opens an array of NumPy. Its shape decides: (N, 3) and (N) are points or voxels, as
/// open_npy_points() says. (X, Y, Z) is a volume of bools, integers or real numbers; element
/// [x][y][z] belongs to voxel (x, y, z). (X, Y, Z, 3) and (X, Y, Z, 4) of uint8 are a volume of
/// colours: an RGBA voxel is set by its alpha, an RGB voxel by the greatest of its channels.
/// Volumes are in C or Fortran order. Throws Error if a threshold is given for points.
std::unique_ptr<VoxelSource> open_npy(const std::filesystem::path& path,
                                      std::optional<double> threshold,
                                      const LabelRequest& labels = {},
                                      const std::vector<ChannelRequest>& channels = {});

/// Opens a volume of NRRD, with its data in the same file or in one of the same folder: raw, gzip,
/// ascii or hex. The first axis is x. A first axis of 3 or 4 values of uint8 is a colour: an RGBA
/// voxel is set by its alpha, an RGB voxel by the greatest of its channels. If the kind of the
/// first or last of four axes is "list", its layers are joined. The space origin is the centre of
/// voxel (0, 0, 0). Format: see nrrd_header.hpp.
std::unique_ptr<VoxelSource> open_nrrd(const std::filesystem::path& path,
                                       std::optional<double> threshold,
                                       const LabelRequest& labels = {},
                                       const std::vector<ChannelRequest>& channels = {});

/// Opens a folder of PNG files of one size as a volume. The files whose names end in .png and do
/// not begin with a dot are sorted by name, numbers by their value: slice_9.png comes before
/// slice_10.png. File k, counted from 0, has the voxels (x, y, k): x counts pixels from the left, y
/// from the top. With `numbered`, k is the last number in the name instead.
///
/// A grey pixel sets its voxel if its value is at least the threshold, or not 0 without one; if it
/// has alpha, alpha must not be 0 either. An RGB pixel has the greatest of its channels as value,
/// an RGBA pixel its alpha, unless that is opaque in all slices. Values are 0 to 255, or 0 to 65535
/// in files of 16 bits. The volume has colours if the first slice has; all slices are grey if the
/// first one is. Images are decoded one at a time.
///
/// Throws Error if labels or channels are wanted of colours, palettes, or grey of less than 8 bits.
std::unique_ptr<VoxelSource> open_png_slices(const std::filesystem::path& folder,
                                             std::optional<double> threshold, bool numbered = false,
                                             const LabelRequest& labels = {},
                                             const std::vector<ChannelRequest>& channels = {});

/// Opens a volume of TIFF: the pages of a file, or the files of a folder whose names end in .tif or
/// .tiff, sorted like those of open_png_slices(). Page k has the voxels (x, y, k). Pages of one
/// channel have integers of 1 to 32 bits or real numbers of 16 to 64; the least value of "white is
/// zero" counts as the greatest. Pages of colours have 8 bits a channel, and set voxels like NRRD.
/// Smaller copies of pages are left out. ImageJ and OME name the sides of voxels; without them,
/// they are 1. Lengths are in the unit of the file. Throws Error for stacks with several channels
/// or frames, and for pages that differ.
///
/// libtiff reads the file, in a module of its own, voxdag_tiff.so.
std::unique_ptr<VoxelSource> open_tiff(const std::filesystem::path& path,
                                       std::optional<double> threshold,
                                       const LabelRequest& labels = {},
                                       const std::vector<ChannelRequest>& channels = {});

/// Opens a series of DICOM: the images in a folder, or one file with one frame or several. The
/// images are placed by their position and orientation, in millimetres: x points to the patient's
/// left, y to the back, z to the head. A threshold is compared with the scaled values (Hounsfield
/// units of CT), which without labels must be given for CT. Throws Error if images differ in size,
/// type or series, if two have one place, if one is missing, or for colours.
///
/// GDCM reads the files, in a module of its own, voxdag_dicom.so, and there in a ConfinedChild.
std::unique_ptr<VoxelSource> open_dicom(const std::filesystem::path& path,
                                        std::optional<double> threshold,
                                        const LabelRequest& labels = {},
                                        const std::vector<ChannelRequest>& channels = {});

/// Returns whether the name `a` comes before `b` if numbers in them are compared by value.
bool is_before_by_numbers(std::string_view a, std::string_view b);

/// Opens a grid of floats, doubles, integers or bools, or a mask, of an OpenVDB file: the one
/// called `grid`. If `grid` is empty: "density", else the first one of the file; a warning names it
/// if there are others. Its active voxels are set; with a threshold those of them whose value is at
/// least that. A level set without a threshold sets its inside instead: all voxels with values
/// below 0. Tiles set all their voxels. Voxels are numbered from the least coordinates that are
/// set; the transform says where their centres are. Labels are the values that set voxels. Channels
/// are the values, there, of the grids that their fields name, or of the grid itself for "value".
/// Throws Error for a grid that has another transform.
///
/// OpenVDB reads the whole file into memory, and is not made for files that one does not trust: a
/// damaged file can crash it. Its exceptions become Error. It is in a module of its own,
/// voxdag_vdb.so, which is built where OpenVDB is installed and found as shared libraries are.
/// Throws Error if there is none.
std::unique_ptr<VoxelSource> open_vdb(const std::filesystem::path& path,
                                      std::optional<double> threshold, const std::string& grid = {},
                                      const LabelRequest& labels = {},
                                      const std::vector<ChannelRequest>& channels = {});

/// Opens a scene of MagicaVoxel: every visible model, with the colours of the palette. A voxel
/// has its index in the palette as label, and keeps its coordinates x, y, z (z is up), less the
/// least ones of the scene, which are the origin of grid(); a voxel has size 1. Animations show
/// their first frame. Where models overlap, all of them set the voxel. Format: see vox_file.hpp.
std::unique_ptr<VoxelSource> open_vox(const std::filesystem::path& path,
                                      const LabelRequest& labels = {});

/// Opens blocks of Minecraft: a schematic of Sponge (.schem) or MCEdit (.schematic), regions of
/// Litematica (.litematic), or a structure (.nbt); the contents tell which. All blocks but air set
/// their voxels, with the colours of color_of_block(); those of MCEdit have numbers and no colours.
/// Labels number the names of blocks, without their states, in the order of the palettes.
/// A block keeps the coordinates of the file, less the least ones of its boxes, which are the
/// origin of grid(); y is up; a block has size 1. Where regions overlap, all of them set the voxel.
std::unique_ptr<VoxelSource> open_schematic(const std::filesystem::path& path,
                                            const LabelRequest& labels = {});

/// Opens a map of OctoMap: .bt, whose nodes are occupied or free, or .ot of the types OcTree and
/// ColorOcTree. The cells of the leaves that are occupied set their voxels, with their colours if
/// the map has some. In .ot, a leaf is occupied if its probability is at least the threshold
/// (0.5 without one). The voxels are those of the map's resolution; z is up.
std::unique_ptr<VoxelSource> open_octomap(const std::filesystem::path& path,
                                          std::optional<double> threshold);

}  // namespace voxdag
