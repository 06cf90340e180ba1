#include "voxdag/formats/imports/volumes/slice_stack.hpp"

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

class SliceSource : public VoxelSource {
 public:
  explicit SliceSource(SliceStack stack) : stack_(std::move(stack)) {
    if (stack_.volume.channels == 4)
      with_bytes([&](const FillBytes& fill) {
        stack_.volume.has_opaque_alpha = has_opaque_alpha(stack_.volume, fill);
      });
  }

  bool has_points() const override { return false; }
  bool has_colors() const override { return stack_.volume.has_colors(); }
  bool has_labels() const override { return stack_.volume.has_labels; }
  std::optional<Grid> grid() const override { return stack_.map.grid(); }
  bool has_place() const override { return stack_.has_place; }
  std::vector<std::string> warnings() const override { return stack_.warnings; }

  void visit_all(const VisitBatch& visit) const override {
    with_bytes([&](const FillBytes& fill) {
      visit_volume(stack_.volume, fill,
                   [&](const VoxelBatch& batch) { stack_.map.visit_cubes(batch, visit); });
    });
  }

 private:
  /// Calls read(fill), where fill() gives the bytes of the volume.
  template <class Read>
  void with_bytes(const Read& read) const {
    const DenseVolume& volume = stack_.volume;
    std::vector<std::byte> slice(
        static_cast<std::size_t>(volume.size[0] * volume.size[1] * volume.voxel_bytes()));
    std::size_t at = slice.size();
    std::uint64_t z = 0;
    read([&](std::span<std::byte> bytes) {
      while (!bytes.empty()) {
        if (at == slice.size()) {
          stack_.read(z++, slice);
          at = 0;
        }
        const std::size_t count = std::min(bytes.size(), slice.size() - at);
        std::copy_n(slice.data() + at, count, bytes.data());
        bytes = bytes.subspan(count);
        at += count;
      }
    });
  }

  SliceStack stack_;
};

/// Opens a file by a module.
std::unique_ptr<VoxelSource> open_by_module(const char* file, const char* name,
                                            const std::string& library,
                                            const std::filesystem::path& path,
                                            std::optional<double> threshold, bool has_labels) {
  std::string reason;
  const auto* const module = static_cast<const SliceModule*>(load_module(file, name, reason));
  if (module == nullptr)
    throw Error(path.string(), "",
                "is read by a module that is built where " + library + " is installed: " + reason);
  return std::unique_ptr<VoxelSource>(module->open(path, threshold, has_labels));
}

}  // namespace

std::unique_ptr<VoxelSource> make_slice_source(const std::filesystem::path& path,
                                               SliceStack stack) {
  const DenseVolume& volume = stack.volume;
  check_volume_size(path, volume.size);
  if (volume.size[0] * volume.size[1] * volume.voxel_bytes() >= kMaxSliceBytes)
    throw Error(path.string(), "header", "a slice has more than a GiB");
  if (volume.has_labels && (volume.channels > 1 || is_real(volume.type)))
    throw Error(path.string(), "header",
                std::string("holds ") + (volume.channels > 1 ? "colours" : "real numbers") +
                    ", not labels");
  return std::make_unique<SliceSource>(std::move(stack));
}

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
                                       std::optional<double> threshold,
                                       const LabelRequest& labels) {
  return open_by_module(kTiffModuleFile, kTiffModuleName, "libtiff (libtiff-dev)", path, threshold,
                        wants_labels(labels));
}

std::unique_ptr<VoxelSource> open_dicom(const std::filesystem::path& path,
                                        std::optional<double> threshold,
                                        const LabelRequest& labels) {
  return open_by_module(kDicomModuleFile, kDicomModuleName, "GDCM (libgdcm-dev)", path, threshold,
                        wants_labels(labels));
}

}  // namespace voxdag
