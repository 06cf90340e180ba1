#include <bit>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {
namespace {

/// The file has a text header, then pairs of bytes (value 0 or 1, count 1 to 255). y runs fastest,
/// then z, then x.
class Binvox : public VoxelSource {
 public:
  explicit Binvox(std::filesystem::path path) : path_(std::move(path)) {
    const MappedFile mapping(path_, MappedFile::Access::kSequential);
    read_header(text_of(mapping));
  }

  bool has_points() const override { return false; }
  std::optional<Grid> grid() const override { return grid_; }
  bool has_place() const override { return has_place_; }
  void visit_all(const VisitBatch& visit) const override {
    const MappedFile mapping(path_, MappedFile::Access::kSequential);
    const std::string_view text = text_of(mapping);
    const std::uint64_t side = static_cast<std::uint64_t>(side_), places = side * side * side;
    BatchedVoxels voxels(visit);
    std::uint64_t place = 0;
    for (std::size_t at = data_; at < text.size(); at += 2) {
      const auto value = static_cast<unsigned char>(text[at]);
      if (value > 1) fail(at, "the value is neither 0 nor 1");
      if (at + 1 == text.size()) fail(at, "ends inside a run");
      const auto count = static_cast<unsigned char>(text[at + 1]);
      if (count == 0) fail(at + 1, "the run is empty");
      if (count > places - place) fail(at, "has more values than voxels");
      if (value == 1)
        for (std::uint64_t i = place; i < place + count; ++i)
          voxels.add({static_cast<double>(i / (side * side)), static_cast<double>(i % side),
                      static_cast<double>(i / side % side)});
      place += count;
    }
    voxels.finish();
    if (place != places)
      fail(text.size(),
           "ends after " + std::to_string(place) + " of " + std::to_string(places) + " values");
  }

 private:
  static std::string_view text_of(const MappedFile& mapping) {
    return {reinterpret_cast<const char*>(mapping.bytes().data()), mapping.bytes().size()};
  }
  [[noreturn]] void fail(std::size_t byte, const std::string& reason) const {
    throw Error(path_.string(), "byte " + std::to_string(byte), reason);
  }

  void read_header(std::string_view text) {
    constexpr std::size_t kMaxLine = 4096;
    if (!text.starts_with("#binvox 1")) fail(0, "does not begin with \"#binvox 1\"");
    double size[3] = {}, translate[3] = {}, scale[1] = {1};
    for (std::size_t at = 0;;) {
      const std::size_t end = text.substr(0, at + kMaxLine).find('\n', at);
      if (end == std::string_view::npos) fail(at, "the header has no line \"data\"");
      const std::string_view line = text.substr(at, end - at);
      if (line == "data" || line == "data\r") {
        data_ = end + 1;
        break;
      }
      if (line.starts_with("dim ")) read_numbers(line.substr(4), at + 4, size);
      has_place_ |= line.starts_with("translate ") || line.starts_with("scale ");
      if (line.starts_with("translate ")) read_numbers(line.substr(10), at + 10, translate);
      if (line.starts_with("scale ")) read_numbers(line.substr(6), at + 6, scale);
      at = end + 1;
    }
    constexpr int kMaxSide = 1 << kMaxLevels;
    if (!(size[0] >= 1 && size[0] <= kMaxSide) || size[0] != std::floor(size[0]) ||
        size[0] != size[1] || size[0] != size[2])
      fail(0, "the dimensions are not three equal whole numbers from 1 to 1048576");
    if (!(scale[0] > 0)) fail(0, "the scale is not positive");
    side_ = static_cast<std::int64_t>(size[0]);
    grid_.levels = std::max(
        kMinLevels, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(side_) - 1)));
    grid_.origin = {translate[0], translate[1], translate[2]};
    grid_.voxel_size = scale[0] / size[0];
    grid_.quantization_scale = kSubvoxels / grid_.voxel_size;
  }

  template <std::size_t N>
  void read_numbers(std::string_view text, std::size_t place, double (&numbers)[N]) const {
    const char* at = text.data();
    const char* const end = at + text.size();
    for (double& number : numbers) {
      while (at != end && (*at == ' ' || *at == '\t')) ++at;
      const auto [next, error] = std::from_chars(at, end, number);
      if (error != std::errc() || !std::isfinite(number))
        fail(place, "is not " + std::to_string(N) + " finite numbers");
      at = next;
    }
  }

  std::filesystem::path path_;
  Grid grid_;
  bool has_place_ = false;
  std::int64_t side_ = 0;
  std::size_t data_ = 0;
};

}  // namespace

std::unique_ptr<VoxelSource> open_binvox(const std::filesystem::path& path) {
  return std::make_unique<Binvox>(path);
}

}  // namespace voxdag
