#pragma once
/// Walks over the polygons of an export: first to count, then to write them.
#include "voxdag/formats/exports/count_voxels.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/faces/color_texture.hpp"
#include "voxdag/formats/exports/faces/manifold_faces.hpp"
#include "voxdag/formats/exports/faces/shared_vertices.hpp"

namespace voxdag {

/// The kind of polygons that a format stores.
enum class PolygonFormat : std::uint8_t {
  kVertexColors,  ///< Colours of vertices. Polygons of one plane and colour are merged.
  kVertexLooks,   ///< As kVertexColors; vertices may also have normals and materials.
  kFaceColors,    ///< A manifold at least, and colours of triangles.
  kNoColors       ///< No colours and no merged polygons. Vertices have no numbers.
};

/// Every walk visits equal polygons in equal order. In manifolds, faces share their vertices if no
/// attributes of vertices tell them apart.
class ExportedPolygons {
 public:
  /// Keeps references to `voxels` and `options`.
  ExportedPolygons(const VoxelSet& voxels, const Box3i& window, const ExportOptions& options,
                   PolygonFormat format)
      : voxels_(voxels),
        window_(window),
        options_(options),
        format_(format),
        faces_(format == PolygonFormat::kFaceColors ? std::max(options.faces, FaceMesh::kManifold)
                                                    : options.faces),
        look_(options.look_reader()),
        colors_(format != PolygonFormat::kNoColors && look_.has_colors() ? &look_ : nullptr) {}

  bool has_colors() const { return colors_ != nullptr; }
  /// Returns whether colours are written as a texture: options.texture.
  bool has_texture() const { return has_colors() && options_.texture; }

  struct Extent {
    std::uint64_t vertices = 0, triangles = 0;
    Box3d bounds = Box3d::empty();  ///< In voxel coordinates.
    ColorTexture texture;           ///< With has_texture(), and the colours of faces.
  };
  /// Counts vertices and triangles, and collects colours: 40 % of the work.
  Extent measure() {
    Extent extent;
    for_each(
        [&](const FacePolygon& polygon, const SharedVertices& vertices) {
          extent.vertices += vertices.added().size();
          extent.triangles += polygon.triangles.size();
          for (const Vec3d corner : polygon.corners) extent.bounds.extend(corner);
          if (collects_colors()) extent.texture.add(polygon.color);
        },
        0.4);
    extent.texture.finish();
    return extent;
  }
  /// Calls fn(polygon, its vertices) for all polygons, up to the fraction `end` of the work.
  void for_each(const std::function<void(const FacePolygon&, const SharedVertices&)>& fn,
                double end = 1) {
    const bool has_uses = faces_ >= FaceMesh::kManifold && format_ != PolygonFormat::kNoColors;
    const bool are_apart = format_ == PolygonFormat::kVertexLooks    ? !look_.is_empty()
                           : format_ == PolygonFormat::kVertexColors ? has_colors()
                                                                     : false;
    SharedVertices vertices(has_uses && !are_apart, options_.memory);
    walk(end, [&](const FacePolygon& polygon) {
      vertices.add(polygon);
      fn(polygon, vertices);
    });
  }

 private:
  bool collects_colors() const {
    return has_texture() || (has_colors() && format_ == PolygonFormat::kFaceColors);
  }
  void walk(double end, const std::function<void(const FacePolygon&)>& fn) {
    std::uint64_t done = 0, triangles = 0;
    const auto visit = [&](const FacePolygon& polygon) {
      ++done;
      triangles += polygon.triangles.size();
      fn(polygon);
    };
    const auto progress = [&](double fraction) {
      if (options_.progress) options_.progress(done_ + fraction * (end - done_), done);
    };
    if (faces_ >= FaceMesh::kManifold) {
      if (!voxel_count_)
        voxel_count_ = count_voxels(voxels_, window_, ~std::uint64_t{0} - 1,
                                    [&] { report_export(options_, 0, 1); });
      const double count = static_cast<double>(std::max<std::uint64_t>(*voxel_count_, 1));
      for_each_manifold_face(
          voxels_, window_, colors_,
          [&](std::uint64_t voxels) { progress(static_cast<double>(voxels) / count); }, visit,
          faces_ == FaceMesh::kSmooth);
    } else {
      FacePolygon polygon;
      const bool merge = format_ != PolygonFormat::kNoColors;
      const bool cut = merge && faces_ == FaceMesh::kWatertight;
      for_each_rectangle(
          voxels_, window_, colors_, merge, progress, [&](const FaceRectangle& rectangle) {
            cut ? set_cut_rectangle(rectangle, polygon) : set_rectangle(rectangle, polygon);
            visit(polygon);
          });
    }
    if (options_.faces_written != nullptr) *options_.faces_written = triangles;
    done_ = end;
  }

  const VoxelSet& voxels_;
  Box3i window_;
  const ExportOptions& options_;
  PolygonFormat format_;
  FaceMesh faces_;
  LookReader look_;
  LookReader* colors_;
  double done_ = 0;  ///< Fraction of the work.
  std::optional<std::uint64_t> voxel_count_;
};

}  // namespace voxdag
