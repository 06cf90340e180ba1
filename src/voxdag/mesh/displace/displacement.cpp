#include "voxdag/mesh/displace/displacement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

#include "voxdag/core/error.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"
#include "voxdag/mesh/surface/material_textures.hpp"

namespace voxdag {
namespace {

double longest_side(const Mesh& mesh) {
  const Box3d bounds = referenced_bounds(mesh);
  const Vec3d extent = bounds.hi - bounds.lo;
  return std::max({extent.x, extent.y, extent.z});
}

/// Returns whether the mesh would be smaller than a voxel in every grid that holds its
/// displacement.
bool is_too_large(double amount, double side) {
  return !(std::fabs(amount) <= std::ldexp(side, kMaxLevels));
}

std::string too_large_text(double amount, double side) {
  char text[192];
  std::snprintf(text, sizeof text,
                "a displacement by %.6g units is too large for a mesh that is %.6g units long: at "
                "most 2^%d times its length is allowed",
                amount, side, kMaxLevels);
  return text;
}

}  // namespace

std::vector<Displacement> load_displacements(const Mesh& mesh, const Appearance& appearance,
                                             std::vector<std::string>& warnings, Work work) {
  const ImageOptions options = image_options(work);
  std::vector<Displacement> displacements(appearance.materials.size());
  if (appearance.uvs.empty()) return displacements;
  const double side = longest_side(mesh);
  std::map<std::tuple<int, TextureWrap, TextureWrap>, std::shared_ptr<const HeightTexture>> loaded;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    const Material& material = appearance.materials[i];
    const TextureUse& use = material.displacement_map;
    if (!use.exists()) continue;
    work.poll();
    work.report_done("height textures", i, displacements.size());
    const TextureImage& image = appearance.images[use.image];
    const double base = material.displacement_base, gain = material.displacement_gain;
    if (const double most = std::max(std::fabs(base), std::fabs(base + gain));
        is_too_large(most, side)) {
      warnings.push_back(image.name + ": " + too_large_text(most, side) +
                         ": the surface is not displaced");
      continue;
    }
    const auto [place, is_new] = loaded.try_emplace({use.image, use.wrap_u, use.wrap_v});
    if (is_new) try {
        place->second = std::make_shared<HeightTexture>(make_height_texture(
            decode_texture_image(image, options), {use.wrap_u, use.wrap_v}, options));
      } catch (const Cancelled&) {
        throw;
      } catch (const OverMemory&) {
        throw;
      } catch (const Error& error) {
        warnings.push_back(std::string(error.what()) + ": the surface is not displaced");
      }
    displacements[i] = {place->second, base, gain, use.uv, 0};
  }
  return displacements;
}

std::vector<Displacement> displace_all(const Mesh& mesh, const Appearance& appearance,
                                       std::shared_ptr<const HeightTexture> heights, double amount,
                                       double box_size) {
  const double side = longest_side(mesh);
  if (is_too_large(amount, side)) throw Error(too_large_text(amount, side));
  if (appearance.uvs.empty() && !(box_size > 0)) box_size = side / 16;
  return std::vector<Displacement>(std::max<std::size_t>(appearance.materials.size(), 1),
                                   {std::move(heights), 0, amount, {}, std::max(box_size, 0.0)});
}

}  // namespace voxdag
