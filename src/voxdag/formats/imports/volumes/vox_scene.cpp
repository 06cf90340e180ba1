#include "voxdag/formats/imports/volumes/vox_scene.hpp"

#include <limits>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

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

}  // namespace

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

}  // namespace voxdag
