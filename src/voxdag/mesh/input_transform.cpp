#include "voxdag/mesh/input_transform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "voxdag/core/angles.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/number_text.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/mesh/place_vertices.hpp"

namespace voxdag {
namespace {

constexpr std::pair<std::string_view, double> kUnits[] = {
    {"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"in", 0.0254}, {"ft", 0.3048}};

double metres_of(std::string_view unit) {
  for (const auto& [name, metres] : kUnits)
    if (name == unit) return metres;
  throw std::invalid_argument("\"" + std::string(unit) + "\" is none of mm, cm, m, in and ft");
}

int axis_of(std::string_view text) {
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z')
    throw std::invalid_argument("\"" + std::string(text) + "\" is none of x, y and z");
  return text[0] - 'x';
}

double number_of(std::string_view text) {
  if (const std::optional<double> number = number_in(text)) return *number;
  throw std::invalid_argument("\"" + std::string(text) + "\" is not a number");
}

/// Splits "from:to". `from` is empty if there is no colon.
std::pair<std::string_view, std::string_view> from_and_to(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos) return {{}, text};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// Calls body(part) for the parts between commas.
template <class Body>
void for_each_part(std::string_view text, const Body& body) {
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    body(text.substr(0, comma));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
}

}  // namespace

FormatCustom custom_of(const std::string& file_name, const std::string& format) {
  const std::string ending =
      lower_case(format.empty() ? unpacked_name(file_name).extension().string() : "." + format);
  const auto is_one_of = [&](std::initializer_list<std::string_view> endings) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
  };
  if (is_one_of({".gltf", ".glb", ".dae"})) return {1, "m", true};
  if (ending == ".3mf") return {2, "mm", true};
  // assimp turns these, whose z axis is up, so that y is, and makes metres of IFC.
  if (is_one_of({".ifc", ".ifczip"})) return {1, "m", true};
  if (is_one_of({".3ds", ".prj", ".ase", ".ask", ".dxf", ".iqm", ".md2", ".md3", ".mdc", ".mdl",
                 ".md5mesh"}))
    return {1, "", true};
  if (is_one_of({".obj",  ".ply", ".off",     ".fbx",  ".x",    ".x3d", ".x3db",
                 ".lwo",  ".lws", ".lxo",     ".ac",   ".ac3d", ".acc", ".b3d",
                 ".ms3d", ".irr", ".irrmesh", ".mesh", ".pmx",  ".vdb", ".splat"}))
    return {};
  return {2, "", true};
}

void add_settings(const TransformRequest& request, std::map<std::string, std::string>& settings) {
  const auto add = [&](const std::string& name, const std::string& text) {
    const auto [from, to] = from_and_to(text);
    if (!to.empty()) settings[name] = to;
    if (!from.empty()) settings[name + "_from"] = from;
  };
  add("up", request.up);
  add("unit", request.unit);
  if (request.scale != 1) settings["scale"] = number_text(request.scale);
  if (!request.rotate.empty()) settings["rotate"] = request.rotate;
  if (request.translate != Vec3d{})
    settings["translate"] = number_text(request.translate.x) + "," +
                            number_text(request.translate.y) + "," +
                            number_text(request.translate.z);
}

TransformRequest transform_request(const std::map<std::string, std::string>& settings) {
  const auto text = [&](const std::string& name) {
    const auto found = settings.find(name);
    return found == settings.end() ? std::string() : found->second;
  };
  const auto both = [&](const std::string& name) {
    const std::string from = text(name + "_from");
    return from.empty() ? text(name) : from + ":" + text(name);
  };
  TransformRequest request{both("up"), both("unit"), 1, text("rotate"), {}};
  if (const std::string scale = text("scale"); !scale.empty()) request.scale = number_of(scale);
  int axis = 0;
  for_each_part(text("translate"), [&](std::string_view part) {
    request.translate[std::min(axis++, 2)] = number_of(part);
  });
  return request;
}

InputTransform::InputTransform(const TransformRequest& request, const FormatCustom& custom)
    : factor_(request.scale), translate_(request.translate) {
  if (!(request.scale > 0)) throw std::invalid_argument("the scale must be above zero");
  if (!request.unit.empty()) {
    const auto [given, to] = from_and_to(request.unit);
    const double metres = metres_of(to);
    // Files whose format does not say their unit are in that of the result.
    const std::string_view from = given.empty() ? std::string_view(custom.unit) : given;
    if (!from.empty()) factor_ *= metres_of(from) / metres;
  }
  if (!request.up.empty()) {
    const auto [given, to] = from_and_to(request.up);
    const int from_axis = given.empty() ? custom.up : axis_of(given), to_axis = axis_of(to);
    // The turn about the third axis; it is positive if the third one follows in the cycle x, y, z.
    if (from_axis != to_axis)
      turn(3 - from_axis - to_axis, (from_axis + 1) % 3 == to_axis ? 90 : -90);
  }
  for_each_part(request.rotate, [&](std::string_view part) {
    const auto [axis, degrees] = from_and_to(part);
    turn(axis_of(axis), number_of(degrees));
  });
}

void InputTransform::turn(int axis, double degrees) {
  const double quarters = degrees / 90;
  auto [sine, cosine] = sine_and_cosine(degrees * std::numbers::pi / 180);
  if (quarters == std::floor(quarters)) {  // Quarter turns are exact.
    const auto rest = static_cast<int>(std::fmod(std::fmod(quarters, 4) + 4, 4));
    sine = rest == 1 ? 1 : rest == 3 ? -1 : 0;
    cosine = rest == 0 ? 1 : rest == 2 ? -1 : 0;
  }
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  for (Vec3d& column : turn_) {
    const double a = column[u], b = column[v];
    column[u] = cosine * a - sine * b;
    column[v] = sine * a + cosine * b;
  }
}

bool InputTransform::keeps_axes() const {
  return std::all_of(turn_.begin(), turn_.end(), [](const Vec3d& column) {
    return std::abs(column.x) + std::abs(column.y) + std::abs(column.z) == 1 &&
           std::max({std::abs(column.x), std::abs(column.y), std::abs(column.z)}) == 1;
  });
}

FormatCustom custom_after(const TransformRequest& request, const FormatCustom& custom) {
  FormatCustom after;
  const auto [given, to] = from_and_to(request.unit);
  if (request.scale == 1) after.unit = request.unit.empty() ? custom.unit : std::string(to);
  if (!custom.has_up && request.up.empty()) return after;
  const std::string_view from = from_and_to(request.up).first;
  Vec3d up{};
  up[from.empty() ? custom.up : axis_of(from)] = 1;
  const Vec3d turned = InputTransform(request, custom).turned(up);
  for (int axis = 0; axis < 3; ++axis)
    if (turned[axis] == 1) after.up = axis, after.has_up = true;
  return after;
}

void move_mesh(MeshWithAppearance& source, const InputTransform& transform, Work work) {
  if (transform.is_identity()) return;
  const Mesh& mesh = source.mesh;
  place_vertices(
      source.mesh, [&](std::size_t i) { return transform.point(mesh.position(i)); }, work);
  Appearance& appearance = source.appearance;
  polled_for(appearance.normals.size(), 4096, work, "move", [&](std::size_t i) {
    appearance.normals[i] =
        static_cast<Vec3f>(transform.turned(static_cast<Vec3d>(appearance.normals[i])));
  });
  for (Material& material : appearance.materials) {
    material.displacement_base *= static_cast<float>(transform.factor());
    material.displacement_gain *= static_cast<float>(transform.factor());
  }
}

}  // namespace voxdag
