/// Reads NIfTI volumes. Format: nifti1.h and nifti2.h of the NIfTI Data Format Working Group
/// (nifti.nimh.nih.gov).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/dense_source.hpp"
#include "voxdag/formats/imports/volumes/gzip_stream.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

/// Bytes of the longest header.
constexpr std::size_t kNiftiHeaderBytes = 540;

struct NiftiHeader {
  DenseVolume volume;  ///< Without the threshold.
  VolumePlacement placement;
  bool has_more_volumes = false;  ///< Along the axes after z.
  std::uint64_t data = 0;         ///< First byte of the data.
};

using namespace std::string_view_literals;

/// The texts that name the version of a file. Each contains a zero byte.
constexpr std::string_view kPairMagic = "ni1\0"sv, kMagic1 = "n+1\0"sv,
                           kMagic2 = "n+2\0\r\n\x1a\n"sv;

/// Bytes of the fields, and the sizes of those that differ between the versions.
struct FieldPlaces {
  std::size_t header, magic, dim, datatype, pixdim, vox_offset, slope, intercept, qform, sform,
      quaternion, qoffset, srow;
  int dim_bytes, real_bytes, offset_bytes, code_bytes;
};
constexpr FieldPlaces kNifti1{348, 344, 40,  70,  76, 108, 112, 116, 252,
                              254, 256, 268, 280, 2,  4,   4,   2};
constexpr FieldPlaces kNifti2{540, 4,   16,  12,  104, 168, 176, 184, 344,
                              348, 352, 376, 400, 8,   8,   8,   4};

class Parser {
 public:
  Parser(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  NiftiHeader parse() {
    find_version();
    parse_type();
    parse_size();
    parse_values();
    parse_placement();
    return header_;
  }

 private:
  [[noreturn]] void fail(std::size_t byte, const std::string& reason) const {
    throw Error(path_.string(), ErrorPlace::byte(byte), reason);
  }

  std::uint64_t bits(std::size_t at, int count) const {
    if (at + static_cast<std::size_t>(count) > bytes_.size())
      fail(bytes_.size(), "truncated: ends inside the header");
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) {
      const std::size_t byte = at + static_cast<std::size_t>(is_big_endian_ ? i : count - 1 - i);
      value = value << 8 | static_cast<unsigned char>(bytes_[byte]);
    }
    return value;
  }
  std::int64_t integer(std::size_t at, int count) const {
    const int unused = 64 - 8 * count;
    return static_cast<std::int64_t>(bits(at, count) << unused) >> unused;
  }
  /// Reads item `index` of an array of floats or doubles.
  double real(std::size_t at, int index = 0) const {
    at += static_cast<std::size_t>(index * places_.real_bytes);
    if (places_.real_bytes == 4)
      return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits(at, 4)))};
    return std::bit_cast<double>(bits(at, 8));
  }
  Vec3d vector(std::size_t at, int index = 0) const {
    return {real(at, index), real(at, index + 1), real(at, index + 2)};
  }

  /// The first number is the size of the header, in the byte order of the file.
  void find_version() {
    for (const bool is_big_endian : {false, true})
      for (const FieldPlaces& places : {kNifti1, kNifti2}) {
        is_big_endian_ = is_big_endian;
        places_ = places;
        if (bits(0, 4) != places.header) continue;
        const bool is_first = places.real_bytes == 4;
        bits(places.header - 1, 1);  // Checks the length.
        const std::string_view magic = bytes_.substr(places.magic);
        if (is_first && magic.starts_with(kPairMagic))
          fail(places.magic, "has its data in another file, which is not supported");
        if (magic.starts_with(is_first ? kMagic1 : kMagic2)) return;
      }
    fail(0, "is not a NIfTI file");
  }

  void parse_type() {
    DenseVolume& volume = header_.volume;
    volume.is_big_endian = is_big_endian_;
    const std::int64_t code = integer(places_.datatype, 2);
    switch (code) {
      case 2:
        volume.type = ValueType::kUint8;
        return;
      case 4:
        volume.type = ValueType::kInt16;
        return;
      case 8:
        volume.type = ValueType::kInt32;
        return;
      case 16:
        volume.type = ValueType::kFloat;
        return;
      case 64:
        volume.type = ValueType::kDouble;
        return;
      case 128:
        volume.channels = 3;
        return;
      case 256:
        volume.type = ValueType::kInt8;
        return;
      case 512:
        volume.type = ValueType::kUint16;
        return;
      case 768:
        volume.type = ValueType::kUint32;
        return;
      case 1024:
        volume.type = ValueType::kInt64;
        return;
      case 1280:
        volume.type = ValueType::kUint64;
        return;
      case 2304:
        volume.channels = 4;
        return;
      default:
        break;
    }
    fail(places_.datatype, "the data type " + std::to_string(code) +
                               " is not supported: it must be an integer, float32, float64, RGB24 "
                               "or RGBA32");
  }

  /// dim[0] is the number of axes, dim[1] the voxels along x.
  void parse_size() {
    const auto dim = [&](int i) {
      return integer(places_.dim + static_cast<std::size_t>(i * places_.dim_bytes),
                     places_.dim_bytes);
    };
    const std::int64_t axes = dim(0);
    if (axes < 1 || axes > 7)
      fail(places_.dim, "has " + std::to_string(axes) + " axes; 1 to 7 are allowed");
    for (int i = 1; i <= axes; ++i) {
      const std::int64_t side = dim(i);
      // Files are not careful with the axes after z.
      if (i > 3 && side < 1) continue;
      if (side < 1) fail(places_.dim, "axis " + std::to_string(i) + " has no voxels");
      if (i <= 3)
        header_.volume.size[i - 1] = static_cast<std::uint64_t>(side);
      else
        header_.has_more_volumes |= side > 1;
    }
    for (std::uint64_t& side : header_.volume.size) side = side == 0 ? 1 : side;
    check_volume_size(path_, header_.volume.size);
  }

  void parse_values() {
    const double slope = real(places_.slope), intercept = real(places_.intercept);
    // A slope of 0: the values are not scaled.
    if (slope != 0 && std::isfinite(slope) && header_.volume.channels == 1) {
      header_.volume.slope = slope;
      header_.volume.intercept = std::isfinite(intercept) ? intercept : 0;
    }
    if (places_.offset_bytes == 8) {
      const std::int64_t offset = integer(places_.vox_offset, 8);
      if (offset < std::int64_t{kNiftiHeaderBytes})
        fail(places_.vox_offset, "the data begin inside the header");
      header_.data = static_cast<std::uint64_t>(offset);
    } else {
      const double offset = real(places_.vox_offset);
      if (!(offset >= static_cast<double>(places_.header)) || offset > 1e9 ||
          offset != std::floor(offset))
        fail(places_.vox_offset, "the data do not begin at a byte after the header");
      header_.data = static_cast<std::uint64_t>(offset);
    }
  }

  void parse_placement() {
    VolumePlacement& placement = header_.placement;
    Vec3d spacing;
    for (int axis = 0; axis < 3; ++axis) {
      spacing[axis] = std::abs(real(places_.pixdim, axis + 1));
      placement.is_known |= spacing[axis] != 0 && spacing[axis] != 1;
      if (spacing[axis] == 0) spacing[axis] = 1;
      Vec3d& step = placement.steps[static_cast<std::size_t>(axis)];
      step = step * spacing[axis];
    }
    const auto sform_step = [&](int axis) {
      return Vec3d{real(places_.srow, axis), real(places_.srow, 4 + axis),
                   real(places_.srow, 8 + axis)};
    };
    const bool has_qform = integer(places_.qform, places_.code_bytes) > 0;
    // Some writers set the code of an sform that they leave 0.
    const bool is_sform_zero =
        sform_step(0) == Vec3d{} && sform_step(1) == Vec3d{} && sform_step(2) == Vec3d{};
    if (integer(places_.sform, places_.code_bytes) > 0 && !(is_sform_zero && has_qform)) {
      // Three rows of a matrix whose last column is the place of voxel (0, 0, 0).
      placement.first_centre =
          Vec3d{real(places_.srow, 3), real(places_.srow, 7), real(places_.srow, 11)};
      for (int axis = 0; axis < 3; ++axis)
        placement.steps[static_cast<std::size_t>(axis)] = sform_step(axis);
      placement.is_known = true;
    } else if (has_qform) {
      placement.first_centre = vector(places_.qoffset);
      placement.is_known = true;
      // The quaternion's real part follows from the others. The sign of pixdim[0] mirrors z.
      const Vec3d q = vector(places_.quaternion);
      const double b = q.x, c = q.y, d = q.z, a = std::sqrt(std::max(0.0, 1 - dot(q, q)));
      const double mirror = real(places_.pixdim) < 0 ? -1 : 1;
      placement.steps = {
          Vec3d{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)} *
              spacing.x,
          Vec3d{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)} *
              spacing.y,
          Vec3d{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c} *
              (spacing.z * mirror)};
    }
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  bool is_big_endian_ = false;
  FieldPlaces places_ = kNifti1;
  NiftiHeader header_;
};

/// Parses the header at the start of `bytes`, which are those of the uncompressed file. Throws
/// Error with the byte.
NiftiHeader parse_nifti_header(const std::filesystem::path& path, std::string_view bytes) {
  return Parser(path, bytes).parse();
}

/// Returns the header's bytes: fewer if the file is shorter.
std::string header_bytes(const std::filesystem::path& path, std::string_view text, bool is_gzip) {
  if (!is_gzip) return std::string(text.substr(0, kNiftiHeaderBytes));
  std::array<std::byte, kNiftiHeaderBytes> bytes{};
  const std::size_t count = GzipStream(path, text, 0).read(bytes);
  return {reinterpret_cast<const char*>(bytes.data()), count};
}

}  // namespace

std::unique_ptr<VoxelSource> open_nifti(const std::filesystem::path& path,
                                        std::optional<double> threshold, const LabelRequest& labels,
                                        const std::vector<ChannelRequest>& channels) {
  MappedFile mapping(path, MappedFile::Access::kSequential);
  const bool is_gzip = mapping.text().starts_with("\x1f\x8b");
  const NiftiHeader header = parse_nifti_header(path, header_bytes(path, mapping.text(), is_gzip));
  DenseFile file{.volume = header.volume,
                 .path = path,
                 .data = std::move(mapping),
                 .encoding = is_gzip ? Encoding::kGzip : Encoding::kRaw,
                 .may_have_more = header.has_more_volumes};
  file.volume.threshold = threshold;
  file.volume.has_labels = wants_labels(labels);
  file.channels = channels;
  file.map = VolumeMap(path, header.volume.size, header.placement, file.warnings);
  file.has_place = header.placement.is_known;
  if (header.has_more_volumes)
    file.warnings.emplace_back("the file has several volumes; only the first one is read");
  (is_gzip ? file.skipped : file.begin) = header.data;
  return make_dense_source(std::move(file));
}

}  // namespace voxdag
