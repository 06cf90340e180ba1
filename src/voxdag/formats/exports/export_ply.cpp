#include "voxdag/formats/exports/export_ply.hpp"

#include <array>
#include <bitset>
#include <limits>
#include <span>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/formats/exports/channel_fields.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/faces/exported_polygons.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {
namespace {

/// A PLY file whose counts are known only at the end. The header is then written again, padded with
/// a comment to its first length.
class PlyFile {
 public:
  struct Content {
    bool faces = false, normals = false, colors = false, materials = false;
    std::string channels = {};  ///< Lines of the header.
  };

  PlyFile(const std::filesystem::path& path, const Grid& grid, const Content& content,
          const std::optional<ExportOptions::Turn>& turn)
      : file_(path), grid_(grid), content_(content), turn_(turn), use_float_(float_suffices(grid)) {
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    header_bytes_ = header(most, most, "").size();
    file_.write_zeros(header_bytes_);
  }

  /// Writes a vertex, with the parts of `look` that the content has, and the values of channels.
  void write_vertex(Vec3d grid_position, const VoxelLook& look,
                    std::span<const std::byte> channels) {
    const Vec3d world = grid_.to_world(grid_position);
    if (use_float_) {
      const Vec3f rounded(world);
      file_.write(&rounded, sizeof rounded);
    } else {
      file_.write(&world, sizeof world);
    }
    if (content_.normals) file_.write(&look.normal, sizeof look.normal);
    if (content_.colors) file_.write(&look.color, sizeof look.color);
    if (content_.materials) file_.write(&look.material, sizeof look.material);
    if (!channels.empty()) file_.write(channels.data(), channels.size());
    ++vertices_;
  }

  void write_face(std::span<const std::uint32_t> vertices) {
    const auto count = static_cast<unsigned char>(vertices.size());
    file_.write(&count, 1);
    file_.write(vertices);
    ++faces_;
  }

  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t faces() const { return faces_; }

  void commit() {
    const std::string unpadded = header(vertices_, faces_, "");
    const std::string text =
        header(vertices_, faces_, std::string(header_bytes_ - unpadded.size(), '.'));
    file_.overwrite(0, text.data(), text.size());
    file_.commit();
  }

 private:
  std::string header(std::uint64_t vertices, std::uint64_t faces,
                     const std::string& padding) const {
    const std::string type = use_float_ ? "float" : "double";
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment made by voxdag\n";
    const auto add_place = [&](const char* name, Vec3d place) {
      text += std::string("comment ") + name;
      for (int axis = 0; axis < 3; ++axis) text += " " + shortest(place[axis]);
      text += "\n";
    };
    add_place("grid_origin", grid_.origin);
    text += "comment voxel_size " + shortest(grid_.voxel_size) + "\n";
    text += "comment resolution " + std::to_string(grid_.resolution()) + "\n";
    if (turn_) {
      text += std::string("comment up ") + turn_->up + "\ncomment from_up " + turn_->from_up + "\n";
      add_place("origin_before", turn_->origin);
    }
    text += "comment " + padding + "\nelement vertex " + std::to_string(vertices) + "\n";
    for (const char axis : {'x', 'y', 'z'}) text += "property " + type + " " + axis + "\n";
    if (content_.normals)
      for (const char axis : {'x', 'y', 'z'}) text += std::string("property float n") + axis + "\n";
    if (content_.colors)
      for (const char* channel : {"red", "green", "blue"})
        text += std::string("property uchar ") + channel + "\n";
    if (content_.materials) text += "property ushort material\n";
    text += content_.channels;
    if (content_.faces)
      text +=
          "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n";
    return text + "end_header\n";
  }

  AtomicFile file_;
  Grid grid_;
  Content content_;
  std::optional<ExportOptions::Turn> turn_;
  bool use_float_;
  std::size_t header_bytes_ = 0;
  std::uint64_t vertices_ = 0, faces_ = 0;
};

PlyFile::Content content_of(const LookReader& look, const ChannelFields& channels, bool faces) {
  constexpr const char* kTaken[] = {"x",   "y",     "z",    "nx",    "ny",      "nz",
                                    "red", "green", "blue", "alpha", "material"};
  constexpr const char* kTypes[] = {"uchar", "ushort", "short", "int", "float"};
  std::string lines;
  for (std::size_t i = 0; i < channels.count(); ++i)
    lines += std::string("property ") + kTypes[static_cast<std::size_t>(channels.kind(i))] + " " +
             channels.name(i, kTaken) + "\n";
  return {faces, look.has_normals(), look.has_colors(), look.has_materials(), lines};
}

/// The look and the channels of a voxel.
struct VertexValues {
  explicit VertexValues(const ExportOptions& options)
      : look(options.look_reader()), channels(look) {}
  VertexValues(const VertexValues&) = delete;
  VertexValues& operator=(const VertexValues&) = delete;

  bool is_empty() const { return look.is_empty() && channels.is_empty(); }
  void read(Vec3i voxel, int level) {
    if (!look.is_empty()) of_voxel = look.read(voxel, level);
    if (!channels.is_empty()) fields = channels.row(voxel, level);
  }

  LookReader look;
  ChannelFields channels;
  VoxelLook of_voxel;
  std::span<const std::byte> fields;
};

constexpr int kCorners = 5 * 5 * 5;  ///< Corners of the voxels of a leaf block.

int corner_index(Vec3i corner) { return corner.x + 5 * (corner.y + 5 * corner.z); }

/// The faces of a leaf block's voxels whose neighbours are not set.
struct BlockSurface {
  /// faces[2 * axis + side] is the mask of the voxels with an outer face on the low (0) or high (1)
  /// side.
  std::array<std::uint64_t, 6> faces{};
  std::bitset<kCorners> corners;  ///< Corners that the faces use.
};

/// Returns the corners of a face, counter-clockwise from outside.
std::array<Vec3i, 4> face_corners(Vec3i voxel, int axis, int side) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<Vec3i, 4> corners;
  corners.fill(voxel);
  for (Vec3i& corner : corners) corner[axis] += side;
  ++corners[side == 1 ? 1 : 3][u];
  ++corners[2][u];
  ++corners[2][v];
  ++corners[side == 1 ? 3 : 1][v];
  return corners;
}

/// Moves every voxel's bit to the neighbour with a higher coordinate on an axis; bits of `below`,
/// the neighbouring block, move in. shift_down() moves bits in the opposite direction. In Morton
/// order, a step inside an octant of 2³ moves a bit by the axis's stride (1, 2 or 4), a step to the
/// next octant by seven strides.
std::uint64_t shift_up(std::uint64_t block, std::uint64_t below, int axis) {
  const auto& slab = kLeafSlabs[axis];
  return (block << (1 << axis) & (slab[1] | slab[3])) | (block << (7 << axis) & slab[2]) |
         (below >> (9 << axis) & slab[0]);
}
std::uint64_t shift_down(std::uint64_t block, std::uint64_t above, int axis) {
  const auto& slab = kLeafSlabs[axis];
  return (block >> (1 << axis) & (slab[0] | slab[2])) | (block >> (7 << axis) & slab[1]) |
         (above << (9 << axis) & slab[3]);
}

template <class Fn>
void for_each_face(const BlockSurface& surface, const Fn& fn) {
  for (int face = 0; face < 6; ++face)
    for (std::uint64_t left = surface.faces[face]; left != 0; left &= left - 1)
      fn(face_corners(morton_decode(static_cast<std::uint64_t>(std::countr_zero(left))), face / 2,
                      face % 2));
}

/// Sets the corners that the faces use.
void find_corners(BlockSurface& surface) {
  for_each_face(surface, [&](const std::array<Vec3i, 4>& corners) {
    for (const Vec3i corner : corners) surface.corners.set(corner_index(corner));
  });
}

BlockSurface block_surface(const VoxelSet& voxels, const Box3i& window, Vec3i origin,
                           std::uint64_t block) {
  const auto neighbour = [&](int axis, int step) {
    Vec3i at = origin;
    at[axis] += step;
    return voxels.leaf_block_at(at) & leaf_window_mask(at, window);
  };
  BlockSurface surface;
  for (int axis = 0; axis < 3; ++axis) {
    surface.faces[2 * axis] = block & ~shift_up(block, neighbour(axis, -4), axis);
    surface.faces[2 * axis + 1] = block & ~shift_down(block, neighbour(axis, 4), axis);
  }
  find_corners(surface);
  return surface;
}

/// Calls fn(surface, voxel) for the parts of a block's surface whose faces share corners: for each
/// voxel that has faces if `by_voxel`, otherwise for the whole block with its origin as `voxel`.
template <class Fn>
void for_each_part(const BlockSurface& whole, Vec3i origin, bool by_voxel, const Fn& fn) {
  if (!by_voxel) return fn(whole, origin);
  std::uint64_t left = 0;
  for (const std::uint64_t faces : whole.faces) left |= faces;
  for (; left != 0; left &= left - 1) {
    BlockSurface part;
    for (std::size_t face = 0; face < 6; ++face)
      part.faces[face] = whole.faces[face] & (left & -left);
    find_corners(part);
    fn(part, origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(left))));
  }
}

void check_corner_count(const std::filesystem::path& path, const PlyFile& file) {
  if (file.vertices() > std::numeric_limits<std::int32_t>::max())
    throw Error(path.string(), "", "more than 2^31 - 1 corners: choose a smaller window");
}

/// Writes the triangles of a smooth manifold.
void write_smooth(const std::filesystem::path& path, const VoxelSet& voxels, const Box3i& window,
                  const ExportOptions& options, PlyFile& file) {
  ExportedPolygons polygons(voxels, window, options, PolygonFormat::kVertexLooks);
  VertexValues values(options);
  polygons.for_each(
      [&](const FacePolygon& polygon, const SharedVertices& vertices) {
        values.read(polygon.voxel, voxels.levels());
        for (const Vec3d place : vertices.added())
          file.write_vertex(place, values.of_voxel, values.fields);
        check_corner_count(path, file);
      },
      0.5);
  polygons.for_each([&](const FacePolygon& polygon, const SharedVertices& vertices) {
    for (std::array<std::uint32_t, 3> triangle : polygon.triangles) {
      for (std::uint32_t& corner : triangle)
        corner = static_cast<std::uint32_t>(vertices.numbers()[corner]);
      file.write_face(triangle);
    }
  });
}

}  // namespace

void export_ply_points(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                       const ExportOptions& options) {
  refuse_pipe(path);
  const Box3i window = export_window(path, voxels, options);
  VertexValues values(options);
  const LookReader& look = values.look;
  const std::uint64_t vertex_bytes = sizeof(Vec3f) + (look.has_normals() ? sizeof(Vec3f) : 0) +
                                     (look.has_colors() ? sizeof(Value8) : 0) +
                                     (look.has_materials() ? sizeof(std::uint16_t) : 0) +
                                     values.channels.bytes();
  const std::uint64_t count = count_for_export(path, voxels, window, vertex_bytes, options);
  PlyFile file(path, grid, content_of(look, values.channels, false), options.turn);
  export_leaf_blocks(voxels, window, count, options, [&](Vec3i origin, std::uint64_t mask) {
    for (; mask != 0; mask &= mask - 1) {
      const Vec3i voxel =
          origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask)));
      values.read(voxel, voxels.levels());
      file.write_vertex(Vec3d(voxel) + Vec3d{0.5, 0.5, 0.5}, values.of_voxel, values.fields);
    }
  });
  file.commit();
}

void export_ply_faces(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options) {
  refuse_pipe(path);
  const Box3i window = export_window(path, voxels, options);
  VertexValues values(options);
  const bool by_voxel = !values.is_empty();
  PlyFile file(path, grid, content_of(values.look, values.channels, true), options.turn);
  if (options.faces == FaceMesh::kSmooth) {
    write_smooth(path, voxels, window, options, file);
    return file.commit();
  }
  const std::uint64_t count = count_for_export(path, voxels, window, 0, options);
  // In PLY all vertices come before all faces. So two walks compute the same surfaces.
  const auto for_each_surface = [&](const auto& fn) {
    export_leaf_blocks(voxels, window, count, options, [&](Vec3i origin, std::uint64_t block) {
      for_each_part(block_surface(voxels, window, origin, block), origin, by_voxel,
                    [&](const BlockSurface& surface, Vec3i voxel) { fn(surface, origin, voxel); });
    });
  };
  for_each_surface([&](const BlockSurface& surface, Vec3i origin, Vec3i voxel) {
    if (by_voxel) values.read(voxel, voxels.levels());
    for (int i = 0; i < kCorners; ++i)
      if (surface.corners[i])
        file.write_vertex(Vec3d(origin + Vec3i{i % 5, i / 5 % 5, i / 25}), values.of_voxel,
                          values.fields);
    check_corner_count(path, file);
  });
  std::uint32_t first_vertex = 0;
  for_each_surface([&](const BlockSurface& surface, Vec3i, Vec3i) {
    std::array<std::uint32_t, kCorners> vertex_of_corner;
    std::uint32_t next = first_vertex;
    for (int i = 0; i < kCorners; ++i) {
      vertex_of_corner[i] = next;
      next += surface.corners[i] ? 1 : 0;
    }
    for_each_face(surface, [&](const std::array<Vec3i, 4>& corners) {
      std::array<std::uint32_t, 4> vertices;
      for (int i = 0; i < 4; ++i) vertices[i] = vertex_of_corner[corner_index(corners[i])];
      file.write_face(vertices);
    });
    first_vertex = next;
  });
  if (options.faces_written != nullptr) *options.faces_written = file.faces();
  file.commit();
}

}  // namespace voxdag
