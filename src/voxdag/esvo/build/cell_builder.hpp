#pragma once
/// Builds the part of an ESVO below one cell, depth first, from the triangles in it.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4: top-down and
/// greedy. A voxel gets the contour that takes away most of what its shape, cut by its ancestors'
/// contours, has beyond the surface; it is a leaf where the shape is near enough to the surface and
/// colours and normals are uniform enough.
///
/// Which voxels there are is exact (design: exact cover); contours enclose the polygons that the
/// triangles leave in a voxel. What is seen of a leaf is the mean over its polygons, what is seen
/// of another voxel the mean over its leaves, by area.
#include <array>
#include <optional>
#include <vector>

#include "voxdag/esvo/build/surface_light.hpp"
#include "voxdag/esvo/build/surface_triangle.hpp"
#include "voxdag/esvo/encode/esvo_tree.hpp"
#include "voxdag/surface/surface_shading.hpp"
#include "voxdag/voxelize/cell_classify.hpp"

namespace voxdag {

/// What shapes the octree.
struct EsvoSettings {
  bool contours = true;  ///< False: cubes, all of the finest level.
  /// How far a leaf's shape may reach beyond the surface, in voxels of the finest level.
  float max_error = 0.5f;
  /// How much a leaf's points may differ from its colour: greatest difference of a channel, sRGB
  /// encoded, 0 to 1.
  float color_error = 0.03f;
  float normal_error = 0.05f;  ///< And from its normal, in radians.
  bool attributes = true;      ///< Colours and normals.
  /// Baked into the colours: what arrives at a leaf multiplies its colour, and where it differs
  /// more than `color_error` allows there are no leaves above the finest level. Empty: none.
  SurfaceLight light;
};

/// Sums over surface: what a voxel looks like is their mean.
struct SurfaceSum {
  Vec3f color{};   ///< Linear light times area.
  Vec3f normal{};  ///< Times area.
  float area = 0;  ///< Visible area, in voxels² of the finest level.

  /// Both sides of something thin would cancel: a normal that looks the other way is turned round,
  /// as a viewer sees one side at a time.
  void add(const SurfaceSum& other) {
    const float along = dot(normal, other.normal);
    const bool is_opposite =
        along < 0 && 4 * along * along > dot(normal, normal) * dot(other.normal, other.normal);
    color = color + other.color;
    normal = is_opposite ? normal - other.normal : normal + other.normal;
    area += other.area;
  }
};

/// The mean as it is stored. A voxel whose normals cancel gets an arbitrary one.
VoxelValue voxel_value(const SurfaceSum& sum);

/// A voxel with all that is below it.
struct BuiltVoxel {
  bool exists = false;  ///< False: no surface, or all of it cut away by its texture's alpha.
  bool is_leaf = false;
  std::optional<Contour> contour;
  SurfaceSum sum;
  EsvoTree tree;  ///< Node 0 is the voxel, unless it is a leaf.
};

/// What is decided of a voxel before its children are known.
struct VoxelDecision {
  bool is_leaf = false;
  bool is_near = false;  ///< Its shape is near enough to the surface: below it are no contours.
  std::optional<Contour> contour;
};

class CellBuilder {
 public:
  /// `shading` is null where nothing is known but the shape: surfaces are grey then.
  CellBuilder(const EsvoSettings& settings, const SurfaceShading* shading)
      : settings_(settings), shading_(shading) {}

  /// Begins a cell of 2^log2_size voxels without triangles. `shape` is what the ancestors' contours
  /// leave of it, `origin` where it begins in the grid, in voxels.
  void start(int log2_size, Vec3i origin, const ConvexPolyhedron& shape);
  /// Adds a triangle; its origin is that of the cell. `id` is the caller's.
  void add(const SurfaceTriangle& triangle, std::uint32_t id);

  /// How much surface there is, in voxels², and at least one for each triangle.
  double weight() const;

  /// The contour of the cell and whether it is a leaf; cuts shape() by the contour. `parent` is
  /// what was decided of the cell's parent.
  VoxelDecision decide(const VoxelDecision& parent);
  const ConvexPolyhedron& shape() const { return shape_; }
  /// The ids of the triangles that meet each child.
  void split(std::array<std::vector<std::uint32_t>, 8>& children) const;

  /// All below the cell, whose own contour is `decision.contour`.
  BuiltVoxel build(const VoxelDecision& decision);

 private:
  /// What a triangle has in a cell.
  struct Item {
    // Nothing of it is to be zero: polygons are large.
    Item() {}  // NOLINT(clang-analyzer-optin.cplusplus.UninitializedObject): see above

    std::uint32_t triangle;
    std::uint32_t conditions;  ///< Which of the triangle's conditions are open in the cell.
    double area;               ///< In the cell's own coordinates.
    SurfacePolygon polygon;
  };
  /// A voxel with its children known, and the node that says so.
  struct Visited {
    bool exists = false, is_leaf = false;
    std::optional<Contour> contour;
    SurfaceSum sum;
    EsvoNode node;
  };

  void drop_cut_away(std::size_t begin, int log2_size, Vec3i cell);
  /// `sum` becomes what is seen of the cell if it is a leaf.
  VoxelDecision decide(std::size_t begin, int log2_size, Vec3i cell, bool is_near,
                       ConvexPolyhedron& shape, SurfaceSum& sum) const;
  /// `sum` becomes what is seen of it if it is.
  bool is_uniform(std::size_t begin, int log2_size, Vec3i cell, SurfaceSum& sum) const;
  bool is_of_one_look(std::size_t begin) const;
  ContourCandidates candidates(std::size_t begin) const;
  /// Whether no voxel of half the side can have a contour that pays: the shape is too thin across
  /// each direction that it might have.
  bool is_too_thin(std::size_t begin, const ConvexPolyhedron& shape) const;
  /// The mean of what is baked in over the cell's polygons, or nothing if it differs among them
  /// more than a leaf above the finest level allows.
  std::optional<float> light_of(std::size_t begin, int log2_size, Vec3i cell) const;
  /// False if there is nothing that the whole cell could be lit by.
  bool put_in_light(std::size_t begin, int log2_size, Vec3i cell, SurfaceSum& sum) const;
  SurfaceSum sum_of(std::size_t begin, int log2_size, Vec3i cell) const;
  /// A polygon as `shading_` takes it; empty where it looks the same everywhere.
  struct Piece {
    Piece() {}
    std::span<const Vec2f> corners() const { return {points, count}; }

    std::size_t count = 0;
    union {
      Vec2f points[SurfacePolygon::kMaxCorners];  // uninitialised
    };
  };
  Piece piece(const Item& item, int log2_size, Vec3i cell) const;
  SurfaceSample sample(const Item& item, const Piece& of) const;
  void add_to(SurfaceSum& sum, const Item& item, int log2_size, const SurfaceSample& sample) const;
  double area_of(const Item& item, int log2_size) const;
  void set_area(Item& item) const;
  void set_look(SurfaceTriangle& triangle) const;
  Visited visit(std::size_t begin, int log2_size, Vec3i cell, bool is_near,
                ConvexPolyhedron& shape);
  ChildConditions classify(const Item& item, int log2_size, Vec3i cell) const;
  /// Appends what the item at `of` has in a child.
  void add_part(std::size_t of, const ChildConditions& classified, int child);
  Visited visit_children(std::size_t begin, int log2_size, Vec3i cell, bool is_near,
                         const ConvexPolyhedron& shape);

  EsvoSettings settings_;
  const SurfaceShading* shading_;
  int log2_size_ = 0;
  Vec3i origin_{};
  ConvexPolyhedron shape_;
  std::vector<SurfaceTriangle> triangles_;
  std::vector<std::uint32_t> ids_;
  std::vector<Item> items_;                  // stack of lists, one for each cell on the way
  std::vector<ChildConditions> classified_;  // likewise
  mutable std::vector<PlanarPolygon> polygons_;
  EsvoTree tree_;  // nodes stand in reverse: children before parents, siblings from last to first
};

}  // namespace voxdag
