/// Formats: teem.sourceforge.net/nrrd/format.html; itk.org/Wiki/MetaIO; vtk.org, "VTK XML file
/// formats"; nifti1.h of the NIfTI Data Format Working Group.
#include "voxdag/formats/exports/volume_file.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/grids/gzip_file.hpp"

namespace voxdag {
namespace {

struct Volume {
  Vec3i size;
  double side;           ///< Of a voxel.
  Vec3d corner, centre;  ///< Of the first voxel.
  bool is_float;
  std::uint64_t bytes() const {
    return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
           static_cast<std::uint64_t>(size.z) * (is_float ? 4 : 1);
  }
};

template <class T>
std::string joined(Vec3<T> v, const std::string& between = " ") {
  const auto text = [](T x) {
    if constexpr (std::is_floating_point_v<T>)
      return shortest(x);
    else
      return std::to_string(x);
  };
  return text(v.x) + between + text(v.y) + between + text(v.z);
}

std::string nrrd_header(const Volume& volume) {
  const std::string side = shortest(volume.side);
  return std::string("NRRD0004\ntype: ") + (volume.is_float ? "float" : "uint8") +
         "\ndimension: 3\nspace dimension: 3\nsizes: " + joined(volume.size) +
         "\nspace directions: (" + side + ",0,0) (0," + side + ",0) (0,0," + side +
         ")\ncenterings: cell cell cell\nkinds: domain domain domain\nendian: little\n"
         "encoding: raw\nspace origin: (" +
         joined(volume.centre, ",") + ")\n\n";
}

std::string meta_image_header(const Volume& volume) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
         "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = " +
         joined(volume.centre) +
         "\nElementSpacing = " + joined(Vec3d{volume.side, volume.side, volume.side}) +
         "\nDimSize = " + joined(volume.size) +
         "\nElementType = " + (volume.is_float ? "MET_FLOAT" : "MET_UCHAR") +
         "\nElementDataFile = LOCAL\n";
}

/// Values of cells: ParaView then shows the cubes.
std::string vti_header(const Volume& volume) {
  const std::string extent = "0 " + std::to_string(volume.size.x) + " 0 " +
                             std::to_string(volume.size.y) + " 0 " + std::to_string(volume.size.z);
  std::string header =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<ImageData WholeExtent=\"" +
      extent + "\" Origin=\"" + joined(volume.corner) + "\" Spacing=\"" +
      joined(Vec3d{volume.side, volume.side, volume.side}) + "\">\n<Piece Extent=\"" + extent +
      "\">\n<CellData Scalars=\"voxels\">\n<DataArray type=\"" +
      (volume.is_float ? "Float32" : "UInt8") +
      "\" Name=\"voxels\" format=\"appended\" offset=\"0\"/>\n</CellData>\n</Piece>\n"
      "</ImageData>\n<AppendedData encoding=\"raw\">\n_";
  const std::uint64_t bytes = volume.bytes();
  return header.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
}
constexpr std::string_view kVtiEnd = "\n</AppendedData>\n</VTKFile>\n";

/// NIfTI-1 with an affine matrix (sform) and no unit.
std::string nifti_header(const Volume& volume) {
  constexpr std::size_t kData = 352;
  std::string header(kData, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(header.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t{348});
  put(40, std::int16_t{3});
  for (std::size_t axis = 0; axis < 7; ++axis)
    put(42 + 2 * axis,
        static_cast<std::int16_t>(axis < 3 ? volume.size[static_cast<int>(axis)] : 1));
  put(70, std::int16_t{volume.is_float ? std::int16_t{16} : std::int16_t{2}});
  put(72, std::int16_t{volume.is_float ? std::int16_t{32} : std::int16_t{8}});
  const auto side = static_cast<float>(volume.side);
  for (std::size_t i = 0; i < 4; ++i) put(76 + 4 * i, i == 0 ? 1.0f : side);
  put(108, static_cast<float>(kData));
  put(112, 1.0f);             // slope
  put(254, std::int16_t{2});  // sform_code: aligned
  for (std::size_t row = 0; row < 3; ++row) {
    put(280 + 16 * row + 4 * row, side);
    put(280 + 16 * row + 12, static_cast<float>(volume.centre[static_cast<int>(row)]));
  }
  std::memcpy(header.data() + 344, "n+1", 4);
  return header;
}

struct Format {
  std::string_view ending;
  std::string (*header)(const Volume&);
  std::string_view end = {};
  std::int32_t most = 1 << kMaxLevels;  ///< Voxels along an axis.
  bool is_packed = false;
};
constexpr std::array<Format, 6> kFormats{{{".nrrd", nrrd_header},
                                          {".mha", meta_image_header},
                                          {".mhd", meta_image_header},
                                          {".vti", vti_header, kVtiEnd},
                                          {".nii", nifti_header, {}, 32767},
                                          {".nii.gz", nifti_header, {}, 32767, true}}};

const Format* format_of(const std::string& name) {
  for (const Format& format : kFormats)
    if (lower_case(name).ends_with(format.ending)) return &format;
  return nullptr;
}

}  // namespace

bool is_volume_name(const std::string& name) { return format_of(name) != nullptr; }

VolumeFile::VolumeFile(const std::filesystem::path& path, const std::string& format,
                       const Grid& grid, const Box3i& window, Values values) {
  const Format& known = *format_of(format);
  const auto lo = static_cast<Vec3d>(window.lo);
  const Volume volume{window.hi - window.lo, grid.voxel_size, grid.to_world(lo),
                      grid.to_world(lo + Vec3d{0.5, 0.5, 0.5}), values == Values::kFloat32};
  if (std::max({volume.size.x, volume.size.y, volume.size.z}) > known.most)
    throw Error(path.string(), "",
                "NIfTI has at most 32,767 voxels along an axis: choose a smaller window or .nrrd");
  if (known.is_packed)
    packed_ = std::make_unique<GzipFile>(path);
  else
    file_ = std::make_unique<AtomicFile>(path);
  const std::string header = known.header(volume);
  write(header.data(), header.size());
  end_ = known.end;
}

VolumeFile::~VolumeFile() = default;

void VolumeFile::write(const void* data, std::size_t bytes) {
  if (packed_)
    packed_->write({static_cast<const char*>(data), bytes});
  else
    file_->write(data, bytes);
}

void VolumeFile::commit() {
  write(end_.data(), end_.size());
  packed_ ? packed_->commit() : file_->commit();
}

}  // namespace voxdag
