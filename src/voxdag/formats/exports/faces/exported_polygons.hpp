#pragma once
/// Walks over the polygons of an export: first to count, then to write them.
#include "voxdag/formats/exports/count_voxels.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/faces/color_texture.hpp"
#include "voxdag/formats/exports/faces/manifold_faces.hpp"

namespace voxdag {

/// Every walk visits equal polygons in equal order.
class ExportedPolygons {
 public:
  /// Keeps references to `voxels` and `options`. Without `merge`, each face is a polygon, and none
  /// has a colour.
  ExportedPolygons(const VoxelSet& voxels, const Box3i& window, const ExportOptions& options,
                   bool merge)
      : voxels_(voxels),
        window_(window),
        options_(options),
        merge_(merge),
        look_(options.look_reader()),
        colors_(merge && look_.has_colors() ? &look_ : nullptr) {}

  bool has_colors() const { return colors_ != nullptr; }
  /// Returns whether colours are written as a texture: options.texture.
  bool has_texture() const { return has_colors() && options_.texture; }

  struct Extent {
    std::uint64_t corners = 0, triangles = 0;
    Box3d bounds = Box3d::empty();  ///< In voxel coordinates.
    ColorTexture texture;           ///< With has_texture().
  };
  /// Counts corners and triangles, and collects colours: 40 % of the work.
  Extent measure() {
    Extent extent;
    walk(0.4, [&](const FacePolygon& polygon) {
      extent.corners += polygon.corners.size();
      extent.triangles += polygon.triangles.size();
      for (const Vec3d corner : polygon.corners) extent.bounds.extend(corner);
      if (has_texture()) extent.texture.add(polygon.color);
    });
    extent.texture.finish();
    return extent;
  }
  /// Calls fn(polygon) for all polygons, up to the fraction `end` of the work.
  void for_each(const std::function<void(const FacePolygon&)>& fn, double end = 1) {
    walk(end, fn);
  }

 private:
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
    if (options_.faces == FaceMesh::kManifold) {
      if (!voxel_count_)
        voxel_count_ = count_voxels(voxels_, window_, ~std::uint64_t{0} - 1,
                                    [&] { report_export(options_, 0, 1); });
      const double count = static_cast<double>(std::max<std::uint64_t>(*voxel_count_, 1));
      for_each_manifold_face(
          voxels_, window_, colors_,
          [&](std::uint64_t voxels) { progress(static_cast<double>(voxels) / count); }, visit);
    } else {
      FacePolygon polygon;
      const bool cut = merge_ && options_.faces == FaceMesh::kWatertight;
      for_each_rectangle(
          voxels_, window_, colors_, merge_, progress, [&](const FaceRectangle& rectangle) {
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
  bool merge_;
  LookReader look_;
  LookReader* colors_;
  double done_ = 0;  ///< Fraction of the work.
  std::optional<std::uint64_t> voxel_count_;
};

}  // namespace voxdag
