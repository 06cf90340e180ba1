/// Reads the maps of OctoMap (A. Hornung et al., "OctoMap: An Efficient Probabilistic 3D Mapping
/// Framework Based on Octrees", 2013). Format: AbstractOcTree and OcTreeBaseImpl of
/// github.com/OctoMap/octomap.
///
/// A text of lines ends with "data". The tree follows, root first, all nodes before their siblings.
/// A node of .bt has two bits for each child: 0 unknown, 1 free (low bit), 2 occupied, 3 inner. A
/// node of .ot has its log odds as float32, in maps with colours three bytes, and a mask of its
/// children. Child i lies in the upper half of x, y and z where bits 0, 1 and 2 of i are set.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {
namespace {

constexpr int kOctoMapLevels = 16;
/// The key of the voxel whose lower corner is the origin of the world.
constexpr std::int64_t kOctoMapCentre = std::int64_t{1} << (kOctoMapLevels - 1);

class OctoMap final : public VoxelSource {
 public:
  OctoMap(const std::filesystem::path& path, std::optional<double> threshold)
      : path_(path), mapping_(path, MappedFile::Access::kSequential) {
    read_header();
    if (threshold && is_binary_)
      throw Error(path_.string(), "", "has no values to compare with a threshold");
    if (threshold && !(*threshold > 0 && *threshold < 1))
      throw Error(path_.string(), "", "the threshold is a probability: more than 0, less than 1");
    if (threshold) least_ = std::log(*threshold / (1 - *threshold));
    find_extent();
  }

  bool has_points() const override { return false; }
  bool has_colors() const override { return has_colors_; }
  bool has_place() const override { return true; }
  std::optional<Grid> grid() const override { return grid_; }
  std::optional<char> up() const override { return 'z'; }
  std::vector<std::string> warnings() const override { return warnings_; }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels voxels(visit);
    walk([&](Vec3l corner, std::int64_t side, Rgb8 color) {
      const auto from = static_cast<Vec3d>(corner - lo_);
      for (std::int64_t z = 0; z < side; ++z)
        for (std::int64_t y = 0; y < side; ++y)
          for (std::int64_t x = 0; x < side; ++x) {
            const Vec3d place = from + static_cast<Vec3d>(Vec3l{x, y, z});
            has_colors_ ? voxels.add(place, color) : voxels.add(place);
          }
    });
    voxels.finish();
  }

 private:
  static constexpr std::uint64_t kMaxMapVoxels = std::uint64_t{1} << 36;

  [[noreturn]] void fail(std::size_t byte, const std::string& reason) const {
    throw Error(path_.string(), ErrorPlace::byte(byte), reason);
  }

  void read_header() {
    const std::string_view text = mapping_.text();
    is_binary_ = text.starts_with("# Octomap OcTree binary file");
    if (!is_binary_ && !text.starts_with("# Octomap OcTree file"))
      fail(0, "does not begin with \"# Octomap OcTree\"");
    std::string_view id;
    double resolution = 0;
    for (std::size_t at = 0;;) {
      constexpr std::size_t kMaxLine = 4096;
      const std::size_t end = text.substr(0, at + kMaxLine).find('\n', at);
      if (end == std::string_view::npos) fail(at, "the header has no line \"data\"");
      const std::string_view line = text.substr(at, end - at);
      if (line.starts_with("id ")) id = line.substr(3);
      if (line.starts_with("res "))
        std::from_chars(line.data() + 4, line.data() + line.size(), resolution);
      if (line.starts_with("size "))
        std::from_chars(line.data() + 5, line.data() + line.size(), nodes_);
      at = end + 1;
      if (line == "data") {
        data_ = at;
        break;
      }
    }
    has_colors_ = id == "ColorOcTree";
    if (id != "OcTree" && (is_binary_ || !has_colors_))
      fail(0, "holds a tree of type \"" + std::string(id) + "\", not OcTree or ColorOcTree");
    if (!(resolution > 0) || !std::isfinite(resolution)) fail(0, "the resolution is not positive");
    grid_.voxel_size = resolution;
    grid_.quantization_scale = kSubvoxels / resolution;
  }

  std::uint8_t byte(std::size_t& at) const {
    if (at >= mapping_.text().size()) fail(at, "truncated: ends inside the tree");
    return static_cast<std::uint8_t>(mapping_.text()[at++]);
  }

  /// Calls visit(corner, side, color) for each occupied leaf. Corners are keys: 0 to 65,535.
  /// Returns the byte after the tree.
  template <class Visit>
  std::size_t walk(const Visit& visit) const {
    std::size_t at = data_;
    if (nodes_ == 0) return at;
    if (is_binary_)
      walk_binary(at, {}, kOctoMapLevels, visit);
    else
      walk_values(at, {}, kOctoMapLevels, visit);
    return at;
  }

  template <class Visit>
  void walk_binary(std::size_t& at, Vec3l corner, int level, const Visit& visit) const {
    if (level == 0) fail(at, "the tree is deeper than 16 levels");
    std::uint32_t states = byte(at);
    states |= std::uint32_t{byte(at)} << 8;
    const std::int64_t side = std::int64_t{1} << (level - 1);
    // The states of all children come before the nodes of the first.
    for (int child = 0; child < 8; ++child) {
      const std::uint32_t state = states >> (2 * child) & 3;
      const Vec3l place = corner + static_cast<Vec3l>(child_offset(child)) * side;
      if (state == 2) visit(place, side, Rgb8{});
      if (state == 3) walk_binary(at, place, level - 1, visit);
    }
  }

  template <class Visit>
  void walk_values(std::size_t& at, Vec3l corner, int level, const Visit& visit) const {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= std::uint32_t{byte(at)} << (8 * i);
    Rgb8 color{};
    if (has_colors_)
      for (std::uint8_t& component : color) component = byte(at);
    const std::uint32_t children = byte(at);
    if (children == 0) {
      if (std::bit_cast<float>(bits) >= least_) visit(corner, std::int64_t{1} << level, color);
      return;
    }
    if (level == 0) fail(at, "the tree is deeper than 16 levels");
    for (int child = 0; child < 8; ++child)
      if (children >> child & 1)
        walk_values(
            at, corner + static_cast<Vec3l>(child_offset(child)) * (std::int64_t{1} << (level - 1)),
            level - 1, visit);
  }

  void find_extent() {
    constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
    Vec3l lo{kNone, kNone, kNone}, hi{};
    std::uint64_t voxels = 0;
    const std::size_t end = walk([&](Vec3l corner, std::int64_t side, Rgb8) {
      lo = min(lo, corner);
      hi = max(hi, corner + Vec3l{side, side, side});
      voxels += static_cast<std::uint64_t>(side * side * side);
    });
    if (end != mapping_.text().size())
      warnings_.push_back(std::to_string(mapping_.text().size() - end) +
                          " bytes after the tree are left out");
    if (voxels == 0) return;
    if (voxels > kMaxMapVoxels)
      fail(data_,
           "has " + std::to_string(voxels) + " voxels, more than " + std::to_string(kMaxMapVoxels));
    grid_.levels = grid_of_scene(path_, lo, hi).levels;
    lo_ = lo;
    grid_.origin = static_cast<Vec3d>(lo - Vec3l{kOctoMapCentre, kOctoMapCentre, kOctoMapCentre}) *
                   grid_.voxel_size;
  }

  std::filesystem::path path_;
  MappedFile mapping_;
  bool is_binary_ = false, has_colors_ = false;
  std::uint64_t nodes_ = 0;
  double least_ = 0;  ///< Log odds.
  std::size_t data_ = 0;
  Grid grid_;
  Vec3l lo_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_octomap(const std::filesystem::path& path,
                                          std::optional<double> threshold) {
  return std::make_unique<OctoMap>(path, threshold);
}

}  // namespace voxdag
