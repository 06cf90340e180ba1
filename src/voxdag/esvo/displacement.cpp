#include "voxdag/esvo/displacement.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "voxdag/surface/material_textures.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

std::vector<Displacement> load_displacements(const Appearance& appearance,
                                             std::vector<std::string>& warnings,
                                             Progress* progress) {
  std::vector<Displacement> displacements(appearance.materials.size());
  if (appearance.uvs.empty()) return displacements;
  std::map<std::tuple<int, TextureWrap, TextureWrap>, std::shared_ptr<const HeightTexture>> loaded;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    const Material& material = appearance.materials[i];
    const TextureUse& use = material.displacement_map;
    if (!use.exists()) continue;
    if (progress != nullptr) progress->throw_if_cancelled();
    const auto [place, is_new] = loaded.try_emplace({use.image, use.wrap_u, use.wrap_v});
    if (is_new) try {
        const TextureImage& image = appearance.images[static_cast<std::size_t>(use.image)];
        place->second = std::make_shared<HeightTexture>(
            make_height_texture(decode_texture_image(image), {use.wrap_u, use.wrap_v}));
      } catch (const Error& error) {
        warnings.push_back(std::string(error.what()) + ": the surface stays without displacement");
      }
    displacements[i] = {place->second, material.displacement_base, material.displacement_gain,
                        use.uv, 0};
  }
  return displacements;
}

std::vector<Displacement> displace_all(const Mesh& mesh, const Appearance& appearance,
                                       std::shared_ptr<const HeightTexture> heights, double amount,
                                       double box_size) {
  if (appearance.uvs.empty() && !(box_size > 0)) {
    const Box3d bounds = referenced_bounds(mesh);
    const Vec3d extent = bounds.hi - bounds.lo;
    box_size = std::max({extent.x, extent.y, extent.z}) / 16;
  }
  return std::vector<Displacement>(std::max<std::size_t>(appearance.materials.size(), 1),
                                   {std::move(heights), 0, amount, {}, std::max(box_size, 0.0)});
}

}  // namespace voxdag
