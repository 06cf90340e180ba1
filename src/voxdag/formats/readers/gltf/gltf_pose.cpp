#include "voxdag/formats/readers/gltf/gltf_pose.hpp"

#include <string>

namespace voxdag {
namespace {

Vec3d to_vec3d(const std::array<float, 3>& v) { return Vec3d(Vec3f{v[0], v[1], v[2]}); }

}  // namespace

GltfPose::GltfPose(const GltfFile& file, GltfAccessors& accessors, const GltfScene& scene)
    : file_(file),
      accessors_(accessors),
      scene_(scene),
      skin_(~std::uint64_t{0}),
      joints_(file.source().work().memory),
      weights_(file.source().work().memory),
      targets_(file.source().work().memory),
      influences_(file.source().work().memory) {}

void GltfPose::start(const GltfInstance& instance) {
  instance_ = &instance;
  is_mirroring_ = instance.transform.is_mirroring();
  weights_.clear();
  has_skin_ = false;
  GltfValue weights = file_.array(GltfArray::kMeshes)[instance.mesh]["weights"];
  if (instance.node != kGltfNoNode) {
    const GltfValue node = file_.array(GltfArray::kNodes)[instance.node];
    if (node["weights"].exists()) weights = node["weights"];
    const GltfValue skin = node["skin"];
    has_skin_ = skin.exists();
    if (has_skin_ && skin.whole() != skin_) {
      read_joints(file_.item(GltfArray::kSkins, skin.whole(), node));
      skin_ = skin.whole();
    }
  }
  for (const GltfValue weight : weights.items()) weights_.push_back(weight.number(0));
}

void GltfPose::read_joints(const GltfValue& skin) {
  const GltfItems joints = skin["joints"].items();
  const GltfValue inverse = skin["inverseBindMatrices"];
  const GltfAccessor* const matrices =
      inverse.exists() ? &accessors_.attributes(inverse.whole(), skin, 16, 16, "joint matrices")
                       : nullptr;
  if (matrices != nullptr && matrices->size() < joints.size())
    throw skin.error(std::to_string(matrices->size()) + " matrices for " +
                     std::to_string(joints.size()) + " joints");
  joints_.clear();
  CancelPoll poll(file_.source().work());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    poll.step();
    const std::uint64_t node = joints[j].whole();
    file_.item(GltfArray::kNodes, node, joints[j]);
    if (!scene_.is_placed[node]) throw joints[j].error("the joint is in a cycle of nodes");
    AffineTransform bind;
    if (matrices != nullptr) {
      const std::array<float, 16> m = matrices->floats<16>(j);
      for (std::size_t c = 0; c < 4; ++c)
        bind.columns[c] = to_vec3d({m[4 * c], m[4 * c + 1], m[4 * c + 2]});
    }
    joints_.push_back(scene_.nodes[node] * bind);
  }
}

void GltfPose::start(const GltfPrimitive& primitive) {
  primitive_ = &primitive;
  targets_.clear();
  influences_.clear();
  const GltfItems targets = primitive.value["targets"].items();
  const auto moves = [&](const GltfValue& target, const char* name) -> const GltfAccessor* {
    const GltfValue index = target[name];
    if (!index.exists()) return nullptr;
    const GltfAccessor& values = accessors_.positions(index.whole(), target);
    if (values.size() != primitive.positions->size())
      throw target.error(std::to_string(values.size()) + " values for " +
                         std::to_string(primitive.positions->size()) + " vertices");
    return &values;
  };
  for (std::size_t k = 0; k < targets.size() && k < weights_.size(); ++k)
    if (weights_[k] != 0)
      targets_.push_back({weights_[k], moves(targets[k], "POSITION"),
                          primitive.normals != nullptr ? moves(targets[k], "NORMAL") : nullptr});
  if (has_skin_) read_influences(primitive);
}

void GltfPose::read_influences(const GltfPrimitive& primitive) {
  const GltfValue attributes = primitive.value["attributes"];
  constexpr std::array<std::array<const char*, 2>, 4> kNames = {{{"JOINTS_0", "WEIGHTS_0"},
                                                                 {"JOINTS_1", "WEIGHTS_1"},
                                                                 {"JOINTS_2", "WEIGHTS_2"},
                                                                 {"JOINTS_3", "WEIGHTS_3"}}};
  for (const auto& names : kNames) {
    std::array<const GltfAccessor*, 2> found{};
    for (std::size_t a = 0; a < 2; ++a) {
      const GltfValue index = attributes[names[a]];
      if (!index.exists()) return;
      found[a] = &accessors_.attributes(index.whole(), primitive.value, 4, 4, names[a]);
      if (found[a]->size() != primitive.positions->size())
        throw primitive.value.error(std::string(names[a]) + " of " +
                                    std::to_string(found[a]->size()) + " elements for " +
                                    std::to_string(primitive.positions->size()) + " vertices");
    }
    for (std::size_t i = 0; i < found[0]->size(); ++i) {
      file_.source().work().poll_seldom(i);
      const std::array<float, 4> joints = found[0]->floats<4>(i), weights = found[1]->floats<4>(i);
      for (std::size_t k = 0; k < 4; ++k)
        if (weights[k] > 0 && !(joints[k] >= 0 && joints[k] < static_cast<float>(joints_.size())))
          throw primitive.value.error("a joint of vertex " + std::to_string(i) +
                                      " does not exist: the skin has " +
                                      std::to_string(joints_.size()));
    }
    influences_.push_back({found[0], found[1]});
  }
}

AffineTransform GltfPose::skinned(std::size_t i) const {
  AffineTransform sum{};
  sum.columns = {};
  double total = 0;
  for (const Influences& four : influences_) {
    const std::array<float, 4> joints = four.joints->floats<4>(i);
    const std::array<float, 4> weights = four.weights->floats<4>(i);
    for (std::size_t k = 0; k < 4; ++k) {
      if (!(weights[k] > 0)) continue;
      const auto weight = static_cast<double>(weights[k]);
      total += weight;
      const AffineTransform& joint = joints_[static_cast<std::size_t>(joints[k])];
      for (std::size_t c = 0; c < 4; ++c)
        sum.columns[c] = sum.columns[c] + joint.columns[c] * weight;
    }
  }
  if (!(total > 0)) return instance_->transform;  // No joint holds the vertex.
  for (Vec3d& column : sum.columns) column = column * (1 / total);
  return sum;
}

Vec3d GltfPose::morphed(std::size_t i, bool is_normal) const {
  Vec3d value = to_vec3d((is_normal ? primitive_->normals : primitive_->positions)->floats<3>(i));
  for (const Target& target : targets_)
    if (const GltfAccessor* const moves = is_normal ? target.normals : target.positions)
      value = value + to_vec3d(moves->floats<3>(i)) * target.weight;
  return value;
}

}  // namespace voxdag
