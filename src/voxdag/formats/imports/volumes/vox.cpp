#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"
#include "voxdag/formats/imports/volumes/vox_file.hpp"

namespace voxdag {
namespace {

/// A model in the scene.
struct VoxInstance {
  std::uint32_t model = 0;
  VoxRotation rotation;
  Vec3i translation;

  /// Returns where a voxel of a model of this size lies in the scene. The pivot is the corner of
  /// the model's voxels at half of its size, rounded down. A mirrored voxel begins where its upper
  /// side was.
  Vec3l place(Vec3i voxel, Vec3i size) const {
    Vec3l placed;
    for (int row = 0; row < 3; ++row) {
      const int axis = rotation.axis[row];
      const std::int64_t from_pivot = std::int64_t{voxel[axis]} - size[axis] / 2;
      const bool is_negative = rotation.is_negative[row];
      placed[row] = (is_negative ? -from_pivot - 1 : from_pivot) + translation[row];
    }
    return placed;
  }
};

constexpr int kMaxDepth = 1000;
constexpr std::size_t kMaxInstances = std::size_t{1} << 20;
/// Nodes that a walk visits. A graph in which nodes have several parents can have more paths than
/// there is time for.
constexpr std::uint64_t kMaxVisits = std::uint64_t{1} << 22;

Vec3l rotated(const VoxRotation& rotation, Vec3i v) {
  Vec3l result;
  for (std::size_t row = 0; row < 3; ++row) {
    const std::int64_t component = v[rotation.axis[row]];
    result[static_cast<int>(row)] = rotation.is_negative[row] ? -component : component;
  }
  return result;
}

/// Returns the rotation that rotates by `inner` and then by `outer`.
VoxRotation product(const VoxRotation& outer, const VoxRotation& inner) {
  VoxRotation result;
  for (std::size_t row = 0; row < 3; ++row) {
    result.axis[row] = inner.axis[outer.axis[row]];
    result.is_negative[row] = outer.is_negative[row] != inner.is_negative[outer.axis[row]];
  }
  return result;
}

class Walk {
 public:
  Walk(const std::filesystem::path& path, const VoxFile& file) : path_(path), file_(file) {}

  std::vector<VoxInstance> walk() {
    const auto root = file_.nodes.find(0);
    if (root == file_.nodes.end()) throw Error(path_.string(), "", "the scene has no node 0");
    visit(root->second, {}, 0);
    return std::move(instances_);
  }

 private:
  [[noreturn]] void fail(const VoxNode& node, const std::string& reason) const {
    throw Error(path_.string(), ErrorPlace::byte(node.byte), reason);
  }

  /// `placement` is the product of the transforms above.
  void visit(const VoxNode& node, VoxInstance placement, int depth) {
    if (depth > kMaxDepth)
      fail(node, "the scene is deeper than 1000 nodes, or has a node inside itself");
    if (++visits_ > kMaxVisits) fail(node, "the scene repeats its groups more than 4194304 times");
    if (node.is_hidden || file_.hidden_layers.contains(node.layer)) return;
    if (node.kind == VoxNode::Kind::kShape) {
      add(node, placement);
      return;
    }
    if (node.kind == VoxNode::Kind::kTransform) move(node, placement);
    for (const std::int32_t id : node.children) {
      const auto child = file_.nodes.find(id);
      if (child == file_.nodes.end()) fail(node, "there is no node " + std::to_string(id));
      visit(child->second, placement, depth + 1);
    }
  }

  void move(const VoxNode& node, VoxInstance& placement) const {
    const Vec3l by = rotated(placement.rotation, node.translation);
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t sum = placement.translation[axis] + by[axis];
      // Half of the range leaves room for the voxels of a model.
      constexpr std::int64_t kFarthest = std::numeric_limits<std::int32_t>::max() / 2;
      if (sum < -kFarthest || sum > kFarthest)
        fail(node, "is moved farther than 1073741823 voxels from the origin");
      placement.translation[axis] = static_cast<std::int32_t>(sum);
    }
    placement.rotation = product(placement.rotation, node.rotation);
  }

  void add(const VoxNode& node, VoxInstance placement) {
    const std::int32_t model = node.children[0];
    if (model < 0 || static_cast<std::size_t>(model) >= file_.models.size())
      fail(node, "there is no model " + std::to_string(model));
    if (instances_.size() == kMaxInstances) fail(node, "the scene has more than 1048576 models");
    placement.model = static_cast<std::uint32_t>(model);
    instances_.push_back(placement);
  }

  const std::filesystem::path& path_;
  const VoxFile& file_;
  std::vector<VoxInstance> instances_;
  std::uint64_t visits_ = 0;
};

/// Returns all visible models of the scene, from node 0 on. A file without a scene has all models
/// with their corner at 0. Throws Error for a graph that is not a tree or DAG of nodes, and if it
/// has more than 1,048,576 instances or is deeper than 1000 nodes.
std::vector<VoxInstance> place_models(const std::filesystem::path& path, const VoxFile& file) {
  if (!file.nodes.empty()) return Walk(path, file).walk();
  std::vector<VoxInstance> instances(file.models.size());
  for (std::uint32_t i = 0; i < file.models.size(); ++i) {
    const Vec3i size = file.models[i].size;
    instances[i].model = i;
    instances[i].translation = {size.x / 2, size.y / 2, size.z / 2};
  }
  return instances;
}

/// Voxels of all instances of all models.
constexpr std::uint64_t kMaxSceneVoxels = std::uint64_t{1} << 36;

class Vox : public VoxelSource {
 public:
  Vox(const std::filesystem::path& path, bool has_labels)
      : path_(path),
        mapping_(path),
        file_(parse_vox(path, mapping_.text())),
        has_labels_(has_labels) {
    instances_ = place_models(path, file_);
    find_extent();
  }

  bool has_points() const override { return false; }
  bool has_colors() const override { return true; }
  bool has_palette() const override { return true; }
  bool has_labels() const override { return has_labels_; }
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
        if (bytes[3] == 0 || !model.contains(voxel)) continue;
        if (has_labels_) voxels.add_label(bytes[3]);
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
    grid_ = grid_of_scene(path_, lo, hi + Vec3l{1, 1, 1});
    lo_ = lo;
  }

  std::filesystem::path path_;
  MappedFile mapping_;
  VoxFile file_;
  bool has_labels_;
  std::vector<VoxInstance> instances_;
  Grid grid_;
  Vec3l lo_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_vox(const std::filesystem::path& path,
                                      const LabelRequest& labels) {
  return std::make_unique<Vox>(path, wants_labels(labels));
}

}  // namespace voxdag
