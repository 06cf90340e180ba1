#pragma once
/// Moves the coordinates of an input before the grid is placed: converts the unit, turns the up
/// axis, scales, rotates and translates, in this order.
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// The up axis and the unit that a format has by its specification or by custom.
struct FormatCustom {
  int up = 1;           ///< The axis that points up: 0 (x), 1 (y) or 2 (z).
  std::string unit;     ///< A unit of TransformRequest; empty: the format has none.
  bool has_up = false;  ///< Whether the format has an up axis; if not, y is assumed.
};
/// Returns the customs of `format` ("obj"), or, if it is empty, of the format that the ending of
/// the file's name tells. z is up in .stl, .3mf, .blend and files of points and volumes, y in
/// others; .gltf, .glb, .dae and .ifc are in metres, .3mf in millimetres. Those of a mesh that
/// assimp reads are those of what assimp gives: it turns .3ds, .ase, .dxf and others so that y is
/// up.
FormatCustom custom_of(const std::string& file_name, const std::string& format = {});

/// A move of the input: the values of --up, --unit, --scale, --rotate and --translate, as texts
/// where the option takes text. SceneMetadata::build stores them.
struct TransformRequest {
  /// "z" turns the up axis of the format to z; "y:z" turns y to z. Empty: no turn.
  std::string up;
  /// Unit of the result: mm, cm, m, in or ft; "in:mm" converts from inches. Empty: not converted.
  std::string unit;
  double scale = 1;    ///< Above 0.
  std::string rotate;  ///< Turns "axis:degrees", counter-clockwise, separated by commas.
  Vec3d translate{};   ///< In units of the result.
  friend bool operator==(const TransformRequest&, const TransformRequest&) = default;
};

/// Adds the members that are set to `settings`, with the keys up, unit, scale, rotate, translate.
/// The keys up_from and unit_from have the axis and the unit of the input, if the request names
/// them.
void add_settings(const TransformRequest& request, std::map<std::string, std::string>& settings);
/// Returns the request that add_settings() added. Throws std::invalid_argument if a value is
/// malformed.
TransformRequest transform_request(const std::map<std::string, std::string>& settings);

/// A turn and a uniform scale, then a translation.
class InputTransform {
 public:
  InputTransform() = default;
  /// Throws std::invalid_argument with the reason if a text of the request is malformed.
  InputTransform(const TransformRequest& request, const FormatCustom& custom);

  bool is_identity() const { return *this == InputTransform(); }
  double factor() const { return factor_; }
  Vec3d turned(Vec3d v) const { return turn_[0] * v.x + turn_[1] * v.y + turn_[2] * v.z; }
  Vec3d point(Vec3d p) const { return turned(p) * factor_ + translate_; }
  /// Returns point(p), measured from `origin` and rounded to float32.
  Vec3f vertex(Vec3d p, Vec3d origin) const { return static_cast<Vec3f>(point(p) - origin); }
  /// Returns whether axes become axes, so that voxels become voxels.
  bool keeps_axes() const;
  friend bool operator==(const InputTransform&, const InputTransform&) = default;

 private:
  void turn(int axis, double degrees);

  std::array<Vec3d, 3> turn_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< Columns.
  double factor_ = 1;
  Vec3d translate_{};
};

/// Returns the up axis and the unit of the coordinates after the move, as far as they are known.
FormatCustom custom_after(const TransformRequest& request, const FormatCustom& custom);

/// Moves vertices, normals and heights of a mesh in double precision, and sets Mesh::origin anew.
/// Throws Error if a vertex that a triangle uses leaves the range of float32, and Cancelled.
void move_mesh(MeshWithAppearance& source, const InputTransform& transform, Work work = {});

}  // namespace voxdag
