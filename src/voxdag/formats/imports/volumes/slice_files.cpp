#include "voxdag/formats/imports/volumes/slice_files.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/load_module.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

bool is_decimal(char c) { return c >= '0' && c <= '9'; }

/// Cuts the digits off the front of a name. Returns them without leading zeros.
std::string_view cut_number(std::string_view& name) {
  std::size_t end = 0;
  while (end < name.size() && is_decimal(name[end])) ++end;
  std::string_view digits = name.substr(0, end);
  name.remove_prefix(end);
  while (digits.starts_with('0')) digits.remove_prefix(1);
  return digits;
}

/// Opens a file by a module.
std::unique_ptr<VoxelSource> open_by_module(const char* file, const char* name,
                                            const std::string& library,
                                            const std::filesystem::path& path,
                                            std::optional<double> threshold, bool has_labels,
                                            const std::vector<ChannelRequest>& channels) {
  std::string reason;
  const auto* const module = static_cast<const SliceModule*>(load_module(file, name, reason));
  if (module == nullptr)
    throw Error(path.string(), "",
                "is read by a module that is built where " + library + " is installed: " + reason);
  return std::unique_ptr<VoxelSource>(module->open(path, threshold, has_labels, channels));
}

}  // namespace

std::vector<std::string> names_of_slices(const std::filesystem::path& folder,
                                         const std::function<bool(const std::string&)>& is_slice) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name[0] != '.' && is_slice(name)) names.push_back(name);
  }
  if (error) throw Error(folder.string(), "", "cannot read the folder: " + error.message());
  std::sort(names.begin(), names.end(), is_before_by_numbers);
  return names;
}

std::optional<std::int64_t> last_number(std::string_view name) {
  const std::size_t end = name.find_last_of("0123456789");
  if (end == name.npos) return std::nullopt;
  std::size_t begin = end;
  while (begin > 0 && is_decimal(name[begin - 1])) --begin;
  std::int64_t number = 0;
  const auto [next, error] = std::from_chars(name.data() + begin, name.data() + end + 1, number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

std::string missing_slices(const std::vector<std::string>& names) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), missing = 0;
  std::size_t first = 0;
  for (const bool is_counting : {false, true})
    for (std::size_t i = 1; i < names.size(); ++i) {
      const auto a = last_number(names[i - 1]), b = last_number(names[i]);
      if (!a || !b || *b <= *a) return {};
      const std::int64_t step = *b - *a;
      if (!is_counting) least = std::min(least, step);
      if (!is_counting || step == least) continue;
      if (missing == 0) first = i;
      missing += step / least - 1;
    }
  // Two slices have one step, which is the least one: a step of 1 is expected of them.
  if (names.size() == 2 && least > 1) {
    missing = least - 1;
    first = 1;
  }
  if (missing == 0) return {};
  return std::to_string(missing) + (missing == 1 ? " slice is" : " slices are") +
         " missing, the first between " + in_quotes(names[first - 1]) + " and " +
         in_quotes(names[first]) + "; the others lie next to each other";
}

bool is_before_by_numbers(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_decimal(a[0]) && is_decimal(b[0])) {
      const std::string_view number_a = cut_number(a), number_b = cut_number(b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else {
      if (a[0] != b[0]) return a.substr(0, 1) < b.substr(0, 1);  // As unsigned characters.
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // They differ in leading zeros only.
}

bool is_dicom(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  char start[132] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof start);
  return std::string_view(start + 128, 4) == "DICM";
}

bool has_dicom(const std::filesystem::path& folder) {
  return !names_of_slices(folder, [&](const std::string& name) {
            return is_dicom(folder / name);
          }).empty();
}

std::unique_ptr<VoxelSource> open_tiff(const std::filesystem::path& path,
                                       std::optional<double> threshold, const LabelRequest& labels,
                                       const std::vector<ChannelRequest>& channels) {
  return open_by_module(kTiffModuleFile, kTiffModuleName, "libtiff (libtiff-dev)", path, threshold,
                        wants_labels(labels), channels);
}

std::unique_ptr<VoxelSource> open_dicom(const std::filesystem::path& path,
                                        std::optional<double> threshold, const LabelRequest& labels,
                                        const std::vector<ChannelRequest>& channels) {
  return open_by_module(kDicomModuleFile, kDicomModuleName, "GDCM (libgdcm-dev)", path, threshold,
                        wants_labels(labels), channels);
}

}  // namespace voxdag
