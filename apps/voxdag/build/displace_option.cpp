#include "build/displace_option.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "cli/parse.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/scenes/stone_heights.hpp"
#include "voxdag/image/decode.hpp"
#include "voxdag/mesh/surface/material_textures.hpp"

namespace voxdag::cli {

void parse_displace(const std::string& text, DisplaceArguments& arguments) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t colon = text.find(':', begin);
    parts.push_back(text.substr(begin, colon - begin));
    if (colon == std::string::npos) break;
    begin = colon + 1;
  }
  const auto number = [](const std::string& part) -> std::optional<double> {
    try {
      const std::vector<double> values = parse_numbers(part);
      return values.size() == 1 ? std::optional(values[0]) : std::nullopt;
    } catch (const std::invalid_argument&) {
      return std::nullopt;
    }
  };
  std::optional<double> last = number(parts.back());
  if (parts.size() >= 3 && last && number(parts[parts.size() - 2])) {
    arguments.scale = *last;
    if (!(arguments.scale > 0)) throw std::invalid_argument("the scale must be greater than zero");
    parts.pop_back();
    last = number(parts.back());
  }
  if (parts.size() < 2 || !last) throw std::invalid_argument("must be TEXTURE:AMOUNT[:SCALE]");
  arguments.amount = *last;
  parts.pop_back();
  arguments.texture = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) arguments.texture += ":" + parts[i];
  if (arguments.texture.empty()) throw std::invalid_argument("must be TEXTURE:AMOUNT[:SCALE]");
}

Option add_displace_option(const Command& command, DisplaceArguments& arguments) {
  const auto parse = [base = arguments](const std::string& text) {
    DisplaceArguments parsed = base;
    parse_displace(text, parsed);
    return parsed;
  };
  return command.parsed(
      "--displace", arguments, parse, "TEXTURE:AMOUNT[:SCALE]",
      "Displace the surface by a height texture (an image, or \"stone\", a built-in wall) by up "
      "to AMOUNT world units; the texture repeats every SCALE world units (default: it follows the "
      "texture coordinates)");
}

Option add_no_displacement_option(const Command& command, DisplaceArguments& arguments) {
  return command.flag("--no-displacement", arguments.is_off,
                      "Ignore the height maps of the materials");
}

std::optional<DisplacedTriangles> open_displaced(const DisplaceArguments& arguments,
                                                 const Mesh& mesh, const Appearance& appearance,
                                                 std::vector<std::string>& warnings, Work work) {
  std::vector<Displacement> displacements;
  if (!arguments.texture.empty()) {
    const ImageOptions options = image_options(work);
    const auto heights = std::make_shared<const HeightTexture>(
        arguments.texture == "stone"
            ? make_stone_heights(1, 1024)
            : make_height_texture(read_image(arguments.texture, options), {}, options));
    displacements = displace_all(mesh, appearance, heights, arguments.amount, arguments.scale);
  } else if (!arguments.is_off) {
    displacements = load_displacements(mesh, appearance, warnings, work);
  }
  if (std::none_of(displacements.begin(), displacements.end(),
                   [](const Displacement& d) { return d.moves(); }))
    return std::nullopt;
  return std::optional<DisplacedTriangles>(std::in_place, mesh, appearance,
                                           std::move(displacements));
}

Box3d displaced_bounds(const DisplacedTriangles& displaced, const Mesh& mesh) {
  Box3d bounds = Box3d::empty();
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Box3d box = displaced.displaced_bounds(i);
    bounds.extend(box.lo);
    bounds.extend(box.hi);
  }
  return bounds;
}

std::string displace_text(const DisplaceArguments& arguments) {
  if (arguments.texture.empty()) return "";
  const std::string text = fmt::format(
      "{}:{}", arguments.texture.substr(arguments.texture.find_last_of('/') + 1), arguments.amount);
  return arguments.scale > 0 ? fmt::format("{}:{}", text, arguments.scale) : text;
}

}  // namespace voxdag::cli
