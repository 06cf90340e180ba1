#pragma once
/// Places the vertices of glTF meshes: morph targets first, then a skin or the node's transform.
#include "voxdag/formats/readers/gltf/gltf_instances.hpp"
#include "voxdag/formats/readers/gltf/gltf_mesh.hpp"

namespace voxdag {

/// Places the vertices of one primitive of one instance at a time. Refers to its arguments.
class GltfPose {
 public:
  GltfPose(const GltfFile& file, GltfAccessors& accessors, const GltfScene& scene);

  /// Starts an instance: reads its morph weights, those of the node or else of the mesh, and the
  /// joints of its skin in their rest pose. Throws Error, OverMemory, Cancelled.
  void start(const GltfInstance& instance);
  /// Starts a primitive of the instance's mesh. Throws Error if a morph target or a joint is not
  /// in range, OverMemory.
  void start(const GltfPrimitive& primitive);

  /// Returns the position of vertex `i` of the primitive, in world units.
  Vec3d position(std::size_t i) const { return transform(i).point(morphed(i, false)); }
  /// Returns the unit normal of vertex `i` of a primitive with normals; zero if it has no
  /// direction.
  Vec3f normal(std::size_t i) const {
    return static_cast<Vec3f>(normalized_or(transform(i).normal(morphed(i, true)), {}));
  }
  /// Returns whether triangles around vertex `i` are turned over.
  bool is_mirrored(std::size_t i) const {
    return influences_.empty() ? is_mirroring_ : skinned(i).is_mirroring();
  }

 private:
  /// A morph target that moves the primitive.
  struct Target {
    double weight;
    const GltfAccessor *positions, *normals;  ///< Null: none.
  };
  /// Four joints of each vertex and their weights.
  struct Influences {
    const GltfAccessor *joints, *weights;
  };

  /// Returns the transform of a vertex.
  AffineTransform transform(std::size_t i) const {
    return influences_.empty() ? instance_->transform : skinned(i);
  }
  AffineTransform skinned(std::size_t i) const;
  Vec3d morphed(std::size_t i, bool is_normal) const;
  void read_joints(const GltfValue& skin);
  void read_influences(const GltfPrimitive& primitive);

  const GltfFile& file_;
  GltfAccessors& accessors_;
  const GltfScene& scene_;
  const GltfInstance* instance_ = nullptr;
  const GltfPrimitive* primitive_ = nullptr;
  bool is_mirroring_ = false;  ///< The node's transform is.
  bool has_skin_ = false;
  std::uint64_t skin_;                     ///< The skin of `joints_`.
  CountedVector<AffineTransform> joints_;  ///< From the mesh to the world.
  CountedVector<double> weights_;          ///< Of the morph targets.
  CountedVector<Target> targets_;
  CountedVector<Influences> influences_;
};

}  // namespace voxdag
