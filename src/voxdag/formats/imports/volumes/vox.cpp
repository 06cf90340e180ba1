#include "voxdag/formats/imports/volumes/vox.hpp"

#include <bit>
#include <limits>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/volumes/vox_file.hpp"
#include "voxdag/formats/imports/volumes/vox_scene.hpp"

namespace voxdag {
namespace {

/// Voxels of all instances of all models.
constexpr std::uint64_t kMaxSceneVoxels = std::uint64_t{1} << 36;

class Vox : public VoxelSource {
 public:
  explicit Vox(const std::filesystem::path& path)
      : path_(path), mapping_(path), file_(parse_vox(path, mapping_.text())) {
    instances_ = place_models(path, file_);
    find_extent();
  }

  bool has_points() const override { return false; }
  bool has_colors() const override { return true; }
  bool has_palette() const override { return true; }
  std::optional<Grid> grid() const override { return grid_; }
  Vec3l first_voxel() const override { return lo_; }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings = file_.warnings;
    if (file_.nodes.empty() && file_.models.size() > 1)
      warnings.push_back("the file has no scene: its " + std::to_string(file_.models.size()) +
                         " models lie on top of each other");
    return warnings;
  }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels voxels(visit);
    for (const VoxInstance& instance : instances_) {
      const VoxModel& model = file_.models[instance.model];
      if (model.is_empty()) continue;
      const auto* bytes =
          reinterpret_cast<const unsigned char*>(mapping_.text().data() + model.first_voxel);
      for (std::uint32_t i = 0; i < model.count; ++i, bytes += 4) {
        const Vec3i voxel{bytes[0], bytes[1], bytes[2]};
        if (bytes[3] != 0 && model.contains(voxel))
          voxels.add(static_cast<Vec3d>(instance.place(voxel, model.size) - lo_),
                     file_.palette[bytes[3]]);
      }
    }
    voxels.finish();
  }

 private:
  /// Sets the grid that the voxels of all instances need.
  void find_extent() {
    constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
    Vec3l lo{kNone, kNone, kNone}, hi{-kNone, -kNone, -kNone};
    std::uint64_t voxels = 0;
    for (const VoxInstance& instance : instances_) {
      const VoxModel& model = file_.models[instance.model];
      if (model.is_empty()) continue;
      voxels += model.count;
      for (const Vec3i corner : {model.lo, model.hi}) {
        const Vec3l placed = instance.place(corner, model.size);
        lo = min(lo, placed);
        hi = max(hi, placed);
      }
    }
    if (voxels == 0) return;
    if (voxels > kMaxSceneVoxels)
      throw Error(path_.string(), "",
                  "the scene has " + std::to_string(voxels) + " voxels, more than " +
                      std::to_string(kMaxSceneVoxels));
    std::int64_t last = 0;
    for (int axis = 0; axis < 3; ++axis) last = std::max(last, hi[axis] - lo[axis]);
    grid_.levels =
        std::max(kMinLevels, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(last))));
    if (grid_.levels > kMaxLevels)
      throw Error(path_.string(), "",
                  "the scene is " + std::to_string(last + 1) + " voxels long, more than 1048576");
    lo_ = lo;
    grid_.origin = static_cast<Vec3d>(lo);
  }

  std::filesystem::path path_;
  MappedFile mapping_;
  VoxFile file_;
  std::vector<VoxInstance> instances_;
  Grid grid_;
  Vec3l lo_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_vox(const std::filesystem::path& path) {
  return std::make_unique<Vox>(path);
}

}  // namespace voxdag
