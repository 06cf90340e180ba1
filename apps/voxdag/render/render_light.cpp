#include "render/render_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "cli/parse.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {
namespace {

struct LightForm {
  const char* name;
  LightKind kind;
  std::size_t numbers;  // count without a colour
};

constexpr LightForm kForms[] = {{"point", LightKind::kPoint, 3},
                                {"sphere", LightKind::kSphere, 4},
                                {"disc", LightKind::kDisc, 7},
                                {"rect", LightKind::kRectangle, 9}};

/// Throws std::invalid_argument for lights that the renderer would refuse in every grid.
void check(const LightSpec& light) {
  try {
    make_light(light, Grid{});
  } catch (const Error& error) {
    throw std::invalid_argument(error.reason());
  }
}

Vec3d vector_at(const std::vector<double>& v, std::size_t at) {
  return {v[at], v[at + 1], v[at + 2]};
}

}  // namespace

LightSpec parse_light(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  for (const LightForm& form : kForms) {
    if (text.compare(0, colon, form.name) != 0 || colon == text.size()) continue;
    const std::vector<double> v = parse_numbers(text.substr(colon + 1));
    if (v.size() != form.numbers && v.size() != form.numbers + 3)
      throw std::invalid_argument(fmt::format("a {} needs {} numbers, or {} with a colour",
                                              form.name, form.numbers, form.numbers + 3));
    LightSpec light;
    light.kind = form.kind;
    light.position = vector_at(v, 0);
    if (form.kind == LightKind::kSphere) light.radius = v[3];
    if (form.kind == LightKind::kDisc) {
      light.normal = vector_at(v, 3);
      light.radius = v[6];
    }
    if (form.kind == LightKind::kRectangle) {
      light.edge_u = vector_at(v, 3);
      light.edge_v = vector_at(v, 6);
    }
    if (v.size() > form.numbers) light.color = static_cast<Vec3f>(vector_at(v, form.numbers));
    check(light);
    return light;
  }
  throw std::invalid_argument("must begin with point:, sphere:, disc: or rect:");
}

}  // namespace voxdag::cli
