#include "voxdag/formats/imports/volumes/nifti.hpp"

#include <array>

#include "voxdag/formats/imports/volumes/dense_source.hpp"
#include "voxdag/formats/imports/volumes/gzip_stream.hpp"
#include "voxdag/formats/imports/volumes/nifti_header.hpp"

namespace voxdag {
namespace {

/// Returns the header's bytes: fewer if the file is shorter.
std::string header_bytes(const std::filesystem::path& path, std::string_view text, bool is_gzip) {
  if (!is_gzip) return std::string(text.substr(0, kNiftiHeaderBytes));
  std::array<std::byte, kNiftiHeaderBytes> bytes{};
  const std::size_t count = GzipStream(path, text, 0).read(bytes);
  return {reinterpret_cast<const char*>(bytes.data()), count};
}

}  // namespace

std::unique_ptr<VoxelSource> open_nifti(const std::filesystem::path& path,
                                        std::optional<double> threshold) {
  MappedFile mapping(path, MappedFile::Access::kSequential);
  const bool is_gzip = mapping.text().starts_with("\x1f\x8b");
  const NiftiHeader header = parse_nifti_header(path, header_bytes(path, mapping.text(), is_gzip));
  DenseFile file{.volume = header.volume,
                 .path = path,
                 .data = std::move(mapping),
                 .encoding = is_gzip ? Encoding::kGzip : Encoding::kRaw,
                 .may_have_more = header.has_more_volumes};
  file.volume.threshold = threshold;
  file.map = VolumeMap(path, header.volume.size, header.placement, file.warnings);
  file.has_place = header.placement.is_known;
  if (header.has_more_volumes)
    file.warnings.emplace_back("the file has several volumes; only the first one is read");
  (is_gzip ? file.skipped : file.begin) = header.data;
  return make_dense_source(std::move(file));
}

}  // namespace voxdag
