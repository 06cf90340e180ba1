/// The module that reads series of DICOM: the only part that links GDCM, which parses and decodes
/// files in a child process that can only compute.
#include <gdcmImageHelper.h>
#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/confined_child.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/volumes/slice_files.hpp"

namespace voxdag {
namespace {

const gdcm::Tag kModality(0x0008, 0x0060), kSeries(0x0020, 0x000e), kPosition(0x0020, 0x0032),
    kRows(0x0028, 0x0010), kPixelData(0x7fe0, 0x0010);

/// The header of a file, as the child writes it to its parent.
struct DicomHeader {
  char error[200] = {};  ///< Why there is no header; empty: there is one.
  bool has_image = false, has_position = false;
  char series[72] = {}, modality[24] = {};
  std::uint64_t size[3] = {};
  int type = -1;  ///< A ValueType, or -1 for another type.
  double slope = 1, intercept = 0;
  Vec3d first;     ///< Centre of the first voxel.
  Vec3d steps[3];  ///< Between columns, rows and frames; the last one is 0 for one frame.
};
static_assert(std::is_trivially_copyable_v<DicomHeader>);

struct DicomFile : DicomHeader {
  std::filesystem::path path;
  double place = 0;  ///< Along the normal of the image.
};

template <std::size_t N>
void set_text(char (&out)[N], std::string_view text) {
  std::copy_n(text.data(), std::min(text.size(), N - 1), out);
}

template <std::size_t N>
void set_element(char (&out)[N], const gdcm::DataSet& data, const gdcm::Tag& tag) {
  if (!data.FindDataElement(tag)) return;
  const gdcm::ByteValue* const value = data.GetDataElement(tag).GetByteValue();
  if (value == nullptr) return;
  std::string_view text(value->GetPointer(), value->GetLength());
  while (text.ends_with(' ') || text.ends_with('\0')) text.remove_suffix(1);
  set_text(out, text);
}

Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot_of(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

int type_of(const gdcm::PixelFormat& format) {
  constexpr std::pair<gdcm::PixelFormat::ScalarType, ValueType> kTypes[] = {
      {gdcm::PixelFormat::UINT8, ValueType::kUint8},
      {gdcm::PixelFormat::INT8, ValueType::kInt8},
      {gdcm::PixelFormat::UINT16, ValueType::kUint16},
      {gdcm::PixelFormat::INT16, ValueType::kInt16},
      {gdcm::PixelFormat::UINT32, ValueType::kUint32},
      {gdcm::PixelFormat::INT32, ValueType::kInt32},
      {gdcm::PixelFormat::FLOAT32, ValueType::kFloat},
      {gdcm::PixelFormat::FLOAT64, ValueType::kDouble}};
  for (const auto& [scalar, type] : kTypes)
    if (format.GetScalarType() == scalar) return static_cast<int>(type);
  return -1;
}

/// Returns whether the bytes of the file end in its pixels. GDCM would make up the others.
bool has_short_pixels(const gdcm::File& file, std::string_view bytes) {
  const gdcm::TransferSyntax& syntax = file.GetHeader().GetDataSetTransferSyntax();
  const gdcm::DataSet& data = file.GetDataSet();
  if (!data.FindDataElement(kPixelData) || syntax.IsEncapsulated() ||
      syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian)
    return false;  // GDCM notices
  const std::uint32_t length = data.GetDataElement(kPixelData).GetVL();
  std::string start("\xE0\x7F\x10\x00", 4);
  if (syntax.GetSwapCode() == gdcm::SwapCode::BigEndian) start = std::string("\x7F\xE0\x00\x10", 4);
  for (std::size_t at = bytes.find(start); at != bytes.npos; at = bytes.find(start, at + 1)) {
    const std::size_t value = at + (syntax.IsExplicit() ? 8 : 4);
    if (value + 4 > bytes.size()) return true;
    std::uint32_t stored = 0;
    std::memcpy(&stored, bytes.data() + value, 4);
    if (syntax.GetSwapCode() == gdcm::SwapCode::BigEndian) stored = __builtin_bswap32(stored);
    if (stored == length) return bytes.size() - value - 4 < length;
  }
  return false;
}

/// In the child: reads the header of a file.
DicomHeader parse_header(std::string_view bytes) {
  DicomHeader header;
  std::istringstream stream{std::string(bytes)};
  gdcm::Reader reader;
  reader.SetStream(stream);
  if (!reader.ReadUpToTag(kPixelData)) {
    set_text(header.error, "is no file of DICOM that GDCM can read");
    return header;
  }
  const gdcm::File& file = reader.GetFile();
  const gdcm::DataSet& data = file.GetDataSet();
  if (!data.FindDataElement(kRows)) return header;
  header.has_image = true;
  set_element(header.series, data, kSeries);
  set_element(header.modality, data, kModality);
  const std::vector<unsigned int> size = gdcm::ImageHelper::GetDimensionsValue(file);
  for (std::size_t axis = 0; axis < 3; ++axis)
    header.size[axis] = axis < size.size() ? size[axis] : 1;
  const gdcm::PixelFormat format = gdcm::ImageHelper::GetPixelFormatValue(file);
  header.type = type_of(format);
  if (has_short_pixels(file, bytes)) set_text(header.error, "truncated: its image is not whole");
  const std::vector<double> rescale = gdcm::ImageHelper::GetRescaleInterceptSlopeValue(file);
  header.intercept = rescale.at(0);
  header.slope = rescale.at(1);
  if (format.GetSamplesPerPixel() != 1)
    set_text(header.error, "has colours, and a volume of DICOM needs values");
  const std::vector<double> spacing = gdcm::ImageHelper::GetSpacingValue(file);
  const std::vector<double> origin = gdcm::ImageHelper::GetOriginValue(file);
  std::vector<double> axes = gdcm::ImageHelper::GetDirectionCosinesValue(file);
  if (axes.size() != 6) axes = {1, 0, 0, 0, 1, 0};
  const Vec3d along_row{axes[0], axes[1], axes[2]}, along_column{axes[3], axes[4], axes[5]};
  header.has_position = data.FindDataElement(kPosition) || header.size[2] > 1;
  header.first = {origin.at(0), origin.at(1), origin.at(2)};
  header.steps[0] = along_row * spacing.at(0);
  header.steps[1] = along_column * spacing.at(1);
  header.steps[2] =
      cross(along_row, along_column) * (header.size[2] > 1 && spacing.size() > 2 ? spacing[2] : 0);
  return header;
}

/// Runs body(bytes, write) over a file in a child, because damaged files can crash GDCM. Calls
/// read(child) for what the child writes.
template <class Body, class Read>
void in_child(const std::filesystem::path& path, const Body& body, const Read& read) {
  const MappedFile file(path, MappedFile::Access::kSequential);
  ChildLimits limits;
  limits.memory = 2 * kMaxSliceBytes + 4 * std::uint64_t{file.text().size()};
  limits.seconds = 600;
  try {
    ConfinedChild child(limits, [&](const ConfinedChild::Write& write) {
      gdcm::Trace::WarningOff();
      gdcm::Trace::ErrorOff();
      gdcm::Trace::DebugOff();
      body(file.text(), write);
    });
    read(child);
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    throw Error(path.string(), "", "GDCM cannot read it: " + error.reason());
  }
}

/// Reads the header of a file.
DicomFile read_header(const std::filesystem::path& path) {
  DicomFile result;
  in_child(
      path,
      [](std::string_view bytes, const ConfinedChild::Write& write) {
        const DicomHeader header = parse_header(bytes);
        write(&header, sizeof header);
      },
      [&](ConfinedChild& child) {
        child.read(static_cast<DicomHeader*>(&result), sizeof(DicomHeader), {});
      });
  if (result.error[0] != 0) throw Error(path.string(), "", printable(result.error));
  result.path = path;
  result.place = dot_of(result.first, cross(result.steps[0], result.steps[1])) /
                 std::sqrt(dot_of(result.steps[0], result.steps[0]) *
                           dot_of(result.steps[1], result.steps[1]));
  if (result.has_image && !std::isfinite(result.place))
    throw Error(path.string(), "header", "its place or spacing is no number");
  return result;
}

/// Returns the headers of the images of a folder or file.
std::vector<DicomFile> read_headers(const std::filesystem::path& path) {
  std::vector<DicomFile> files;
  const auto add = [&](const std::filesystem::path& file) {
    DicomFile header = read_header(file);
    if (header.has_image) files.push_back(std::move(header));
  };
  if (std::filesystem::is_directory(path)) {
    for (const std::string& name :
         names_of_slices(path, [&](const std::string& name) { return is_dicom(path / name); }))
      add(path / name);
  } else {
    add(path);
  }
  if (files.empty()) throw Error(path.string(), "", "has no images of DICOM");
  return files;
}

/// Sorts the images along the normal, and returns the distance between them. Throws Error unless
/// they are a volume.
double sort_images(const std::filesystem::path& path, std::vector<DicomFile>& files) {
  const DicomFile& first = files.front();
  for (const DicomFile& file : files) {
    const auto fail = [&](const std::string& reason) {
      throw Error(file.path.string(), "header", reason + " as " + first.path.filename().string());
    };
    if (std::string_view(file.series) != first.series)
      throw Error(file.path.string(), "header",
                  "is of another series than " + first.path.filename().string() +
                      ": a folder must have one");
    if (!std::equal(file.size, file.size + 3, first.size)) fail("has not the same size");
    if (file.type != first.type) fail("has not the same type of values");
    if (file.size[2] > 1 && files.size() > 1) fail("has several frames, and is not the only file,");
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const Vec3d apart = file.steps[axis] - first.steps[axis];
      if (dot_of(apart, apart) > 1e-8 * dot_of(first.steps[axis], first.steps[axis]))
        fail("has not the same orientation and spacing");
    }
    if (!file.has_position && files.size() > 1)
      throw Error(file.path.string(), "header", "does not say where it lies (Image Position)");
  }
  if (files.size() == 1) return 0;
  std::stable_sort(files.begin(), files.end(),
                   [](const DicomFile& a, const DicomFile& b) { return a.place < b.place; });
  std::vector<double> distances;
  for (std::size_t i = 1; i < files.size(); ++i)
    distances.push_back(files[i].place - files[i - 1].place);
  std::vector<double> sorted = distances;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const std::string pair =
        files[i].path.filename().string() + " and " + files[i + 1].path.filename().string();
    if (distances[i] < 1e-6) throw Error(path.string(), "", "has two images at one place, " + pair);
    if (std::abs(distances[i] - usual) > 0.02 * usual)
      throw Error(path.string(), "",
                  "its images are not evenly spaced: " + pair + " are " +
                      std::to_string(distances[i]) + " mm apart, most are " +
                      std::to_string(usual) +
                      (distances[i] > 1.5 * usual ? "; are some missing?" : ""));
  }
  return (files.back().place - files.front().place) / static_cast<double>(files.size() - 1);
}

/// Decodes all frames of a file.
std::vector<char> decode(const DicomFile& file, std::size_t bytes) {
  std::vector<char> values(bytes);
  in_child(
      file.path,
      [&](std::string_view file_bytes, const ConfinedChild::Write& write) {
        std::istringstream stream{std::string(file_bytes)};
        gdcm::ImageReader reader;
        reader.SetStream(stream);
        if (!reader.Read()) return;
        const gdcm::Image& image = reader.GetImage();
        std::vector<char> decoded(image.GetBufferLength());
        if (decoded.size() == bytes && image.GetBuffer(decoded.data()))
          write(decoded.data(), decoded.size());
      },
      [&](ConfinedChild& child) { child.read(values.data(), values.size(), {}); });
  return values;
}

VoxelSource* open_dicom_in_module(const std::filesystem::path& path,
                                  std::optional<double> threshold, bool has_labels,
                                  const std::vector<ChannelRequest>& channels) {
  auto files = std::make_shared<std::vector<DicomFile>>(read_headers(path));
  const double distance = sort_images(path, *files);
  const DicomFile first = files->front();
  if (std::string_view(first.modality) == "CT" && !threshold && !has_labels)
    throw Error(path.string(), "",
                "holds a CT, whose air is not 0: give a threshold in Hounsfield units (bone is "
                "above some 300)");
  DenseFile stack;
  stack.path = path;
  stack.encoding = Encoding::kSlices;
  stack.channels = channels;
  DenseVolume& volume = stack.volume;
  volume.size = {first.size[0], first.size[1], first.size[2] * files->size()};
  volume.threshold = threshold;
  volume.has_labels = has_labels;
  if (first.type < 0)
    throw Error(first.path.string(), "header", "its values have a type that is not read");
  const auto stored = static_cast<ValueType>(first.type);
  volume.type = stored;
  const bool has_one_scale = std::all_of(files->begin(), files->end(), [&](const DicomFile& file) {
    return file.slope == first.slope && file.intercept == first.intercept;
  });
  if (has_one_scale) {
    volume.slope = first.slope;
    volume.intercept = first.intercept;
  } else {
    volume.type = ValueType::kDouble;
  }
  VolumePlacement placement;
  placement.steps = {first.steps[0], first.steps[1], first.steps[2]};
  const Vec3d normal = cross(first.steps[0], first.steps[1]);
  const double length = std::sqrt(dot_of(normal, normal));
  if (files->size() > 1) placement.steps[2] = normal * (distance / length);
  // One image has no thickness: it gets that of a pixel.
  if (dot_of(placement.steps[2], placement.steps[2]) == 0)
    placement.steps[2] = normal * (1 / std::sqrt(length));
  if (first.has_position) placement.first_centre = first.first;
  placement.is_known = stack.has_place = true;
  check_volume_size(path, volume.size);
  stack.map = VolumeMap(path, volume.size, placement, stack.warnings);
  const std::size_t values = first.size[0] * first.size[1];
  const std::size_t slice = values * bytes_of(stored);
  const std::size_t frames = first.size[2];
  const auto frames_of_file = std::make_shared<std::vector<char>>();
  stack.read_slice = [=](std::uint64_t z, std::span<std::byte> bytes) {
    const DicomFile& file = (*files)[static_cast<std::size_t>(z) / frames];
    if (z % frames == 0) *frames_of_file = decode(file, slice * frames);
    const char* const begin = frames_of_file->data() + (z % frames) * slice;
    if (has_one_scale) {
      std::memcpy(bytes.data(), begin, slice);
      return;
    }
    with_type(stored, [&]<class T>(T value) {
      for (std::size_t i = 0; i < values; ++i) {
        std::memcpy(&value, begin + i * sizeof value, sizeof value);
        const double scaled = static_cast<double>(value) * file.slope + file.intercept;
        std::memcpy(bytes.data() + i * sizeof scaled, &scaled, sizeof scaled);
      }
    });
  };
  return make_dense_source(std::move(stack)).release();
}

}  // namespace
}  // namespace voxdag

extern "C" const voxdag::SliceModule voxdag_dicom_module = {voxdag::open_dicom_in_module};
