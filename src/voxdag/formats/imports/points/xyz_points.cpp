#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r'; }

class XyzPoints : public VoxelSource {
 public:
  explicit XyzPoints(std::filesystem::path path) : path_(std::move(path)) {}

  bool has_points() const override { return true; }
  void visit_all(const VisitBatch& visit) const override {
    const MappedFile mapping(path_, MappedFile::Access::kSequential);
    const std::string_view text(reinterpret_cast<const char*>(mapping.bytes().data()),
                                mapping.bytes().size());
    BatchedVoxels points(visit);
    std::uint64_t number = 0;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      ++number;
      if (end - at > kMaxLineBytes) fail(number, "is longer than 1 MiB");
      std::string_view line = text.substr(at, end - at);
      line = line.substr(0, line.find('#'));
      Vec3d point;
      if (read_point(line, number, point)) points.add(point);
      at = end + 1;
    }
    points.finish();
  }

 private:
  [[noreturn]] void fail(std::uint64_t line, const std::string& reason) const {
    throw Error(path_.string(), "line " + std::to_string(line), reason);
  }

  /// Returns false for a line without numbers.
  bool read_point(std::string_view line, std::uint64_t number, Vec3d& point) const {
    const char* at = line.data();
    const char* const end = at + line.size();
    for (int axis = 0; axis < 3; ++axis) {
      while (at != end && is_separator(*at)) ++at;
      if (at == end) {
        if (axis == 0) return false;
        fail(number, "has " + std::to_string(axis) + " numbers instead of three");
      }
      if (*at == '+') ++at;
      const auto [next, error] = std::from_chars(at, end, point[axis]);
      if (error != std::errc() || (next != end && !is_separator(*next)) ||
          !std::isfinite(point[axis]))
        fail(number, "number " + std::to_string(axis + 1) + " is not a finite number");
      at = next;
    }
    return true;
  }

  std::filesystem::path path_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_xyz_points(const std::filesystem::path& path) {
  return std::make_unique<XyzPoints>(path);
}

}  // namespace voxdag
