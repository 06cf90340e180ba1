#include <algorithm>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/nrrd_header.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

/// Sets the byte at which the data begin.
void skip_to_data(const NrrdHeader& header, DenseFile& file) {
  const std::string_view text = file.data.text();
  for (std::uint64_t line = 0; line < header.line_skip; ++line) {
    const std::size_t end = text.find('\n', file.begin);
    if (end == std::string_view::npos)
      throw Error(
          file.path.string(), ErrorPlace::byte(text.size()),
          "truncated: ends before the " + std::to_string(header.line_skip) + " lines to skip");
    file.begin = end + 1;
  }
  if (header.byte_skip < 0) {
    if (text.size() - file.begin > file.volume.bytes())
      file.begin = text.size() - file.volume.bytes();
    return;
  }
  const auto skip = static_cast<std::uint64_t>(header.byte_skip);
  if (file.encoding == Encoding::kGzip) {
    file.skipped = skip;
    return;
  }
  if (skip > text.size() - file.begin)
    throw Error(file.path.string(), ErrorPlace::byte(text.size()),
                "truncated: ends before the " + std::to_string(skip) + " bytes to skip");
  file.begin += skip;
}

/// Returns the file of the data: `name`, in the folder of the header or in one below. If it names
/// another place, or does not exist, a file of the same name beside the header stands for it.
std::filesystem::path detached_data(const std::filesystem::path& header, std::string name,
                                    std::vector<std::string>& warnings) {
  const std::filesystem::path folder = header.parent_path();
  const auto exists = [](const std::filesystem::path& path) {
    std::error_code unknown;
    return std::filesystem::is_regular_file(path, unknown);
  };
  if (!exists(folder / name)) std::replace(name.begin(), name.end(), '\\', '/');
  const bool is_below = !name.starts_with('/') && ("/" + name + "/").find("/../") == name.npos;
  const std::filesystem::path beside = folder / name.substr(name.rfind('/') + 1);
  if (is_below && (exists(folder / name) || !exists(beside))) return folder / name;
  if (!exists(beside))
    throw Error(header.string(), "data file",
                name_in_quotes(name) + " is not in the folder of the header");
  warnings.push_back("reads " + name_in_quotes(beside.filename().string()) +
                     ", beside the header, for the data file " + name_in_quotes(name));
  return beside;
}

}  // namespace

std::unique_ptr<VoxelSource> open_nrrd(const std::filesystem::path& path,
                                       std::optional<double> threshold, const LabelRequest& labels,
                                       const std::vector<ChannelRequest>& channels) {
  MappedFile mapping(path, MappedFile::Access::kSequential);
  const NrrdHeader header = parse_nrrd_header(path, mapping.text());
  std::vector<std::string> warnings;
  const VolumeMap map(path, header.volume.size, header.placement, warnings);
  const bool is_detached = !header.data_file.empty();
  const std::filesystem::path data =
      is_detached ? detached_data(path, header.data_file, warnings) : path;
  if (is_detached) mapping = MappedFile(data, MappedFile::Access::kSequential);
  DenseFile file{.volume = header.volume,
                 .map = map,
                 .has_place = header.placement.is_known,
                 .warnings = std::move(warnings),
                 .label_names = header.label_names,
                 .path = data,
                 .data = std::move(mapping),
                 .begin = is_detached ? 0 : header.end,
                 .encoding = header.encoding};
  file.volume.threshold = threshold;
  file.volume.has_labels = wants_labels(labels);
  file.channels = channels;
  skip_to_data(header, file);
  return make_dense_source(std::move(file));
}

}  // namespace voxdag
