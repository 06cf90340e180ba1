#pragma once
/// Opens files of points.
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// The reason why a LAZ file is refused.
inline constexpr const char* kCompressedLas =
    "is a compressed LAS file (LAZ), which is not read: decompress it with laszip or PDAL";

/// Opens an array of N x 3 numbers of any type and order, or a structured array whose rows have the
/// fields x, y and z, or one of three items called voxel, position or xyz. Integers are voxels,
/// real numbers are points. The fields red, green and blue, or color, are colours, in the range of
/// color_range().
std::unique_ptr<VoxelSource> open_npy_points(const std::filesystem::path& path,
                                             const NpyStart& start, const LabelRequest& labels = {},
                                             const std::vector<ChannelRequest>& channels = {});

/// Texts of points whose ending tells where colours are.
enum class PointText : std::uint8_t {
  kAny,
  kPts,    ///< Of 7 or 10 columns, 5 to 7 are the colour, behind the intensity.
  kXyzrgb  ///< Columns 4 to 6 are the colour.
};

/// Opens a text of points: three numbers in each line, and perhaps more. Lines are cut into cells
/// at semicolons, tabs, commas or bars, if the names of the columns or the first points have them;
/// else at blanks, too (TextCells). # and //, and % at the start of a line, begin comments. At most
/// 1 MiB per line.
///
/// A comment or a line before the points may name the columns: x, y, z, r, g, b, or red, green,
/// blue. Without names, the columns behind the coordinates are a colour if the first 4,096 points
/// have whole numbers from 0 to 255 there, not only 0 and 1; behind one column more if not. A line
/// with one whole number counts points. A column of labels or of a channel has a name, or a number
/// from 4 on; channels are f32 by default.
///
/// Throws Error with the line: numbers that are none, commas inside numbers, colours beyond the
/// range of the first points, more names than numbers, and texts in UTF-16.
std::unique_ptr<VoxelSource> open_xyz_points(const std::filesystem::path& path,
                                             const LabelRequest& labels = {},
                                             const std::vector<ChannelRequest>& channels = {},
                                             PointText kind = PointText::kAny);

/// Opens the vertices of a PLY file as points, in ascii and in both binary orders; ignores faces
/// and other elements. Numbers of text are float64, whatever their type is called. The colours are
/// the properties that the mesh reader knows, with its scales: red, green and blue, or
/// diffuse_red ..., or r ...; integers up to the greatest value of 8 or 16 bits, or floats; see
/// color_range() for the range of 16 bits and floats; clamped. Gaussian splats have the colour of
/// f_dc_0 to f_dc_2. Vertices with the properties opacity, scale_0 to scale_2 and rot_0 to rot_3
/// are splats, unless `splats_are_points`. See open_packed_ply() for compressed splats.
///
/// Throws Error with the line (in a binary body with the byte): malformed headers and values,
/// counts that need a longer file, truncation before the end of the vertices.
std::unique_ptr<VoxelSource> open_ply_points(const std::filesystem::path& path,
                                             bool splats_are_points = false,
                                             const LabelRequest& labels = {},
                                             const std::vector<ChannelRequest>& channels = {});

/// Opens a compressed PLY file of PlayCanvas, whose vertices have the property packed_position;
/// returns null for others. Ignores the spherical harmonics above the first. Throws Error: see
/// open_ply_points(), which calls this function.
std::unique_ptr<VoxelSource> open_packed_ply(const std::filesystem::path& path,
                                             bool splats_are_points = false);

/// Opens a .splat file (antimatter15/splat): records of 32 bytes. Each has the centre and the
/// standard deviations, three floats each; red, green, blue and the opacity, one byte each; the
/// rotation w, x, y, z, one byte q each for (q - 128) / 128. Throws Error if the size of the file
/// is no multiple of 32 bytes.
std::unique_ptr<VoxelSource> open_splat_file(const std::filesystem::path& path,
                                             bool splats_are_points = false);

/// Opens an .spz file (Niantic), versions 1 to 4; those up to 3 must be unpacked from gzip. Holds
/// the splats of version 4 in memory, 20 bytes each. Ignores the spherical harmonics above the
/// first. Throws Error for other versions and damaged files, and OverMemory.
std::unique_ptr<VoxelSource> open_spz(const std::filesystem::path& path,
                                      bool splats_are_points = false, const Work& work = {});

/// Opens a .sog file (PlayCanvas), version 2: a ZIP archive of meta.json and images of WebP, which
/// it holds in memory, 12 to 20 bytes a splat. Ignores the spherical harmonics above the first.
/// Throws Error for archives that are damaged, and OverMemory.
std::unique_ptr<VoxelSource> open_sog(const std::filesystem::path& path,
                                      bool splats_are_points = false, const Work& work = {});

/// Opens the points of a LAS file, versions 1.0 to 1.5, point formats 0 to 10. Skips points that
/// are flagged as withheld, which the specification calls deleted; reads synthetic points and all
/// others. Skips variable length records, and reads coordinates as they are, without a reference
/// system.
///
/// Formats 2, 3, 5, 7, 8 and 10 have colours. They have 16 bits, but many programs store 8: if no
/// component in the file exceeds 255, all have 8 bits; otherwise the upper 8 of 16 bits are read.
///
/// Labels are the classification, with the names of the specification, or the field user_data or
/// point_source_id. Channels are intensity and these fields.
///
/// Throws Error with the byte: compressed files, malformed headers, counts that need a longer file.
std::unique_ptr<VoxelSource> open_las_points(const std::filesystem::path& path,
                                             const LabelRequest& labels = {},
                                             const std::vector<ChannelRequest>& channels = {});

/// Opens the points of a PCD file, versions 0.5 to 0.7, with DATA ascii, binary or
/// binary_compressed. x, y and z may have any type; numbers of text are float64. Compressed
/// data that did not shrink may be stored. The viewpoint is ignored.
///
/// The colours are field `rgb` or `rgba` of 4 bytes: 0xAARRGGBB, also as the bits of a float. In
/// text, a number with only digits is that integer; any other number is such a float, and NaN is
/// black. Fields of other sizes are no colours. Fields r, g and b are colours, in the range of
/// color_range().
///
/// Memory is bounded, also for compressed files, which hold one field of all points after another.
/// Throws Error with the line or byte: malformed headers and values, counts that need a longer
/// file, compressed data that is damaged or that promises more than LZF can hold.
std::unique_ptr<VoxelSource> open_pcd_points(const std::filesystem::path& path,
                                             const LabelRequest& labels = {},
                                             const std::vector<ChannelRequest>& channels = {});

}  // namespace voxdag
