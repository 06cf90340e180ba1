#pragma once
/// Compares stored attributes of a DAG's cells with the surface of the mesh.
#include "voxdag/builders/attributes/filter_materials.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"

namespace voxdag {

/// The result of comparing one kind of attribute.
struct ValueCheck {
  std::uint64_t cells = 0;  ///< Number of compared cells.
  double largest_error = 0;
  Vec3i worst{};  ///< The cell with the largest error, in cells of its level.
  int worst_level = 0;
};

struct AttributeCheck {
  ValueCheck colors;     ///< Errors as AttributeOptions::color_bound measures them.
  ValueCheck normals;    ///< Errors in degrees.
  ValueCheck materials;  ///< 1 - area of the stored material / largest area of a material.
  /// The larger error of the two channels, which have the kind u8; 1 is the whole range.
  ValueCheck metallic_roughness;
};

/// Compares random cells of the levels with attributes: at most `samples`, or all cells if there
/// are not more. Filters the surface in each cell again, by the code of the builder but without its
/// encoder and its pages, and compares the result with the stored values. `shading` is the shading
/// of the mesh. Leaves out
///
///   all        cells with more than 65,536 cells in their subtrees
///   colours, metallic, roughness
///              cells without visible surface, whose values come from a cell above
///   normals    also cells in which the normals disagree so much that rounding may decide
///
/// Rounding changes the channels of a colour by one step of 8 bits, which is an error of 1/255, and
/// turns a normal by less than 0.1 degrees; metallic and roughness, see kMirrorTolerance. Materials
/// with equal areas differ by less than 0.001. `mesh` must have materials if the DAG has, or `ids`
/// the ids that the DAG stores. `cover` is the DAG of the mesh if `colored` is that of a solid:
/// then only cells of the surface are compared. The result does not depend on the number of
/// threads. Throws Cancelled.
AttributeCheck check_attributes(const Mesh& mesh, const Grid& grid, const ColoredDagView& colored,
                                const SurfaceShading& shading, std::uint64_t samples,
                                std::uint64_t seed, Work work = {}, const TriangleIds& ids = {},
                                const SvdagView* cover = nullptr);

/// Tolerances for the errors of check_attributes(), to add to the bounds of the encoder. That of
/// metallic and roughness, which are stored without loss, is for sharp edges in textures, where
/// rounding may change the taps of a filter (0.032 was seen, at a step from 0 to 1).
inline constexpr double kColorTolerance = 1.5 / 255, kMirrorTolerance = 0.05,
                        kNormalTolerance = 0.1, kMaterialTolerance = 0.001;

}  // namespace voxdag
