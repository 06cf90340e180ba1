#include "voxdag/formats/scenes/scenes.hpp"

#include <array>
#include <cmath>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/scenes/list.hpp"

namespace voxdag {
namespace {

struct Entry {
  SceneInfo info;
  Mesh (*make)(double size, std::uint32_t seed, Work work);
  ScenePreset (*preset)(double size);
};

constexpr std::array kEntries = {
    Entry{{"city", "blocks of shops, houses and towers, with streets and parks",
           "blocks along a side", 6, 1, 24},
          scenes::make_city,
          scenes::city_preset},
    Entry{{"courtyard", "a cloister court with arcades, vaults, curtains and a fountain",
           "fineness of curves; the number of triangles grows with its square", 1, 0.1, 8},
          scenes::make_courtyard,
          scenes::courtyard_preset},
    Entry{{"hairball", "a ball of thin, curled, tangled hairs", "hairs, of 1440 triangles each",
           2000, 1, 150000},
          scenes::make_hairball,
          scenes::hairball_preset},
    Entry{{"sponge", "a Menger sponge", "depth: the cube is 3^depth cells wide", 4, 1, 6, false},
          scenes::make_sponge,
          scenes::sponge_preset},
    Entry{{"terrain", "eroded mountains above a lake, with rocks and firs",
           "grid cells along a side", 1024, 32, 8192},
          scenes::make_terrain,
          scenes::terrain_preset},
};

constexpr auto kInfos = [] {
  std::array<SceneInfo, kEntries.size()> infos{};
  for (std::size_t i = 0; i < infos.size(); ++i) infos[i] = kEntries[i].info;
  return infos;
}();

const Entry& find(std::string_view name) {
  std::string known;
  for (const Entry& entry : kEntries) {
    if (entry.info.name == name) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.info.name);
  }
  throw Error("unknown scene '" + std::string(name) + "': the scenes are " + known);
}

std::string plain(double v) {
  std::string text = std::to_string(v);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

double checked_size(const SceneInfo& info, double size) {
  if (size == 0) return info.default_size;
  if (!(size >= info.min_size && size <= info.max_size))
    throw Error("scene " + std::string(info.name) + ": size " + plain(size) + " is not between " +
                plain(info.min_size) + " and " + plain(info.max_size) + " (" +
                std::string(info.size_meaning) + ")");
  return size;
}

}  // namespace

std::span<const SceneInfo> scene_list() { return kInfos; }

Mesh make_scene(std::string_view name, const SceneOptions& options, Work work) {
  const Entry& entry = find(name);
  return entry.make(checked_size(entry.info, options.size), options.seed, work);
}

ScenePreset scene_preset(std::string_view name, const SceneOptions& options) {
  const Entry& entry = find(name);
  return entry.preset(checked_size(entry.info, options.size));
}

}  // namespace voxdag
