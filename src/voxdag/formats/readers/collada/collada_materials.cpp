#include "voxdag/formats/readers/collada/collada_materials.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "voxdag/core/srgb.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/xml/xml_mesh.hpp"

namespace voxdag {
namespace {

/// Returns the <newparam> with this sid in an effect or its profile, or null.
const XmlElement* find_parameter(const XmlElement& effect, std::string_view sid) {
  for (const XmlElement& child : effect.children) {
    if (child.name == "newparam" && child["sid"] == sid) return &child;
    if (child.name != "profile_COMMON" && child.name != "technique") continue;
    if (const XmlElement* const found = find_parameter(child, sid)) return found;
  }
  return nullptr;
}

/// Returns the text of the colour of a property, which it has or names as a parameter; null if it
/// has none.
const std::string* color_text(const XmlElement& effect, const XmlElement& property) {
  if (const XmlElement* const color = property.child("color")) return &color->text;
  const XmlElement* const use = property.child("param");
  const XmlElement* const parameter =
      use == nullptr ? nullptr : find_parameter(effect, (*use)["ref"]);
  for (const char* type : {"float3", "float4"})
    if (const XmlElement* const value = parameter == nullptr ? nullptr : parameter->child(type))
      return &value->text;
  return nullptr;
}

}  // namespace

ColladaMaterials::ColladaMaterials(const ColladaDocument& document) : document_(document) {
  materials_[0].base_color = kDefaultColor;
}

std::uint32_t ColladaMaterials::symbol(std::string_view name) {
  return symbols_.try_emplace(std::string(name), static_cast<std::uint32_t>(symbols_.size()))
      .first->second;
}

std::vector<std::uint32_t> ColladaMaterials::bound_by(const XmlElement& instance) {
  std::vector<std::uint32_t> materials(symbols_.size(), 0);
  const XmlElement* const bound = instance.at({"bind_material", "technique_common"});
  if (bound == nullptr) return materials;
  for (const XmlElement& binding : bound->children) {
    const auto symbol = symbols_.find(binding["symbol"]);
    if (symbol != symbols_.end() && binding.name == "instance_material")
      materials[symbol->second] =
          number_of(document_.named(binding, binding["target"], "material"));
  }
  return materials;
}

std::uint32_t ColladaMaterials::number_of(const XmlElement& element) {
  const auto [number, is_new] =
      numbers_.try_emplace(&element, static_cast<std::uint32_t>(materials_.size()));
  if (!is_new) return number->second;
  Material& material = materials_.emplace_back();
  const std::string_view name = element["name"];
  material.name = name.empty() ? element["id"] : name;
  material.base_color = kDefaultColor;
  if (const XmlElement* const use = element.child("instance_effect"))
    read_colors(document_.named(*use, (*use)["url"], "effect"), material);
  return number->second;
}

void ColladaMaterials::read_colors(const XmlElement& effect, Material& material) {
  const XmlElement* const technique = effect.at({"profile_COMMON", "technique"});
  if (technique == nullptr) return;
  for (const char* name : {"phong", "lambert", "blinn", "constant"}) {
    const XmlElement* const shader = technique->child(name);
    if (shader == nullptr) continue;
    const XmlElement* const emission = shader->child("emission");
    if (emission != nullptr && shader->name == "constant") material.base_color = {};
    if (emission != nullptr) read_color(effect, *emission, material.emission);
    if (const XmlElement* const diffuse = shader->child("diffuse"))
      read_color(effect, *diffuse, material.base_color);
  }
}

/// Sets `color` to that of <diffuse> or <emission>.
void ColladaMaterials::read_color(const XmlElement& effect, const XmlElement& property,
                                  Vec3f& color) {
  if (property.child("texture") != nullptr) left_out_.insert("textures are not read");
  const std::string* const text = color_text(effect, property);
  if (text == nullptr) return;
  std::array<float, 4> rgba{};
  std::size_t count = 0;
  std::string_view rest = *text;
  for (std::string_view word; !(word = take_word(rest)).empty(); ++count)
    if (count == 4 || !parse_float(word, rgba[count]) || !std::isfinite(rgba[count])) {
      count = 0;
      break;
    }
  if (count < 3) {
    left_out_.insert("colours that are not three or four numbers are not read");
    return;
  }
  for (std::size_t c = 0; c < 3; ++c)
    color[static_cast<int>(c)] = srgb_to_linear(std::clamp(rgba[c], 0.0f, 1.0f));
}

}  // namespace voxdag
