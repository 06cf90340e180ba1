#pragma once
/// Texture coordinates, normals and colours of a PLY file.
#include <array>
#include <atomic>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// The values of one row that belong to the appearance.
struct PlyRowValues {
  /// The slots of scalar properties; the list `texcoord` has no slot.
  enum Slot { kRed, kGreen, kBlue, kAlpha, kNormalX, kNormalY, kNormalZ, kU, kV, kSlots };

  explicit PlyRowValues(MemoryBudget* memory) : texcoord(memory) {}

  std::array<float, kSlots> scalars{};
  CountedVector<float> texcoord;  ///< u and v of the corners of a face.
};

/// The properties of an element that belong to the appearance.
struct PlyColumns {
  std::vector<int> slots;  ///< PlyRowValues::Slot of each property, or -1.
  int texcoord = -1;       ///< Index of the list `texcoord`, or -1.
  int color_components = 0;
  bool has_normals = false, has_uvs = false, is_splat = false;

  bool is_used() const { return color_components > 0 || has_normals || has_uvs || texcoord >= 0; }
};

/// Collects the attributes while the mesh is read. Threads may pass distinct rows concurrently.
///
/// Reads from vertices: `red green blue` with or without `alpha` (or `diffuse_red` ..., `r` ...;
/// sRGB, in any letter case, integers divided by their type's greatest value, floats 0 to 1 or 0 to
/// 255), else the colour of Gaussian splats, `nx ny nz`, and `s t`, `u v`, `texture_u texture_v` or
/// `texture_s texture_t`. Reads from faces: colours if vertices have none, and the list `texcoord`
/// with two numbers per corner if vertices have no coordinates.
class PlyAttributes {
 public:
  /// If `to_255`, components of colours that are floats or 16-bit integers go from 0 to 255.
  PlyAttributes(const MeshSource& source, const PlyHeader& header, const PlyFields& fields,
                bool to_255);

  const PlyColumns& vertex_columns() const { return vertex_; }
  const PlyColumns& face_columns() const { return face_; }

  /// Makes room for `count` vertices. Throws OverMemory.
  void resize_vertices(std::size_t count);
  void resize_triangles(std::size_t count);

  void take_vertex(std::size_t index, const PlyRowValues& row);
  /// Returns the colour of a face, if faces have colours.
  Rgba16 face_color(const PlyRowValues& row);
  /// Stores the values of triangle `index`, which joins three corners of a face. `texcoord` has u
  /// and v of the face's corners, or is empty.
  void take_triangle(std::size_t index, const Triangle& corners, Rgba16 face_color,
                     std::span<const float> texcoord);

  /// Counts a face that names a texture that does not exist. It has no texture.
  void count_bad_texture() { bad_textures_.fetch_add(1, std::memory_order_relaxed); }
  /// Returns whether the colours so far, read without `to_255`, go from 0 to 255: floats do if
  /// plain_color_scale() says so, 16-bit integers if none exceeds 255.
  bool go_to_255() const;

  /// Completes the appearance: corners, materials, the textures. Call it once, at the end. Throws
  /// Error if a texture is outside the file's folder.
  Appearance finish(const Mesh& mesh, std::vector<std::string>& warnings);

 private:
  Rgba16 color_of(const PlyColumns& columns, const PlyRowValues& row);
  void read_materials(const Mesh& mesh, std::vector<std::string>& warnings);
  void ignore_alpha_that_hides_all();

  const MeshSource& source_;
  const PlyHeader& header_;
  PlyColumns vertex_, face_;
  std::array<float, 4> color_scales_{};  ///< Factors that map the components' type to 0..1.
  float color_offset_ = 0;
  PlyType color_type_ = PlyType::kUint8;  ///< That of red.
  std::atomic<float> greatest_{0};        ///< Component of all colours, if their type is in doubt.
  std::atomic<std::size_t> bad_textures_{0};
  CountedVector<Rgba16> vertex_colors_;
  CountedVector<Vec3f> vertex_normals_;
  CountedVector<Vec2f> vertex_uvs_;
  MemoryReservation memory_;  ///< The arrays of the appearance.
  Appearance appearance_;
};

}  // namespace voxdag
