#include "lab/papers/paper_scenes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

constexpr std::array kScenes{
    PaperScene{Paper::kSvdag, "Crysponza", 279'000},
    PaperScene{Paper::kSvdag, "EpicCitadel", 0},
    PaperScene{Paper::kSvdag, "SanMiguel", 10'500'000},
    PaperScene{Paper::kSvdag, "Hairball", 2'800'000},
    PaperScene{Paper::kSvdag, "Lucy", 28'000'000},
    PaperScene{Paper::kEsvo, "City", 0},
    PaperScene{Paper::kEsvo, "Sibenik", 0},
    PaperScene{Paper::kEsvo, "Sibenik-D", 0},
    PaperScene{Paper::kEsvo, "Hairball", 0},
    PaperScene{Paper::kEsvo, "Fairy", 0},
    PaperScene{Paper::kEsvo, "Conference", 0},
};

/// A mesh whose relation to a scene is known.
struct KnownMesh {
  Paper paper;
  std::string_view scene;
  std::uint64_t file_check;          ///< 0: a procedural scene.
  std::string_view procedural_name;  ///< Empty: a file.
  bool is_displaced;
  SceneState state;
  std::string_view difference;
};

constexpr std::array kKnown{
    KnownMesh{Paper::kSvdag, "Crysponza", kCrytekSponzaCheck, "", false, SceneState::kVariant,
              "262,267 triangles of the model as it is published today, 279 thousand in the paper"},
    KnownMesh{Paper::kSvdag, "SanMiguel", kSanMiguelCoreCheck, "", false, SceneState::kVariant,
              "1,647,885 triangles without plants, 10.5 million in the paper"},
    KnownMesh{Paper::kSvdag, "SanMiguel", 0x8c48e22017e3e0e5, "", false, SceneState::kStandIn,
              "only some of the plants"},
    KnownMesh{Paper::kSvdag, "Lucy", kLucyCheck, "", false, SceneState::kVariant,
              "99,970 triangles, 28 million in the paper"},
    KnownMesh{Paper::kSvdag, "Hairball", 0, "hairball", false, SceneState::kStandIn,
              "a procedural hairball"},
    KnownMesh{Paper::kSvdag, "EpicCitadel", 0, "city", false, SceneState::kStandIn,
              "a procedural city"},
    KnownMesh{Paper::kSvdag, "SanMiguel", 0, "courtyard", false, SceneState::kStandIn,
              "a procedural courtyard"},
    KnownMesh{Paper::kEsvo, "Sibenik", kSibenikCheck, "", false, SceneState::kVariant,
              "80,479 triangles and no textures; the paper does not say how many it has"},
    KnownMesh{Paper::kEsvo, "Sibenik-D", kSibenikCheck, "", true, SceneState::kVariant,
              "80,479 triangles, displaced by another height texture"},
    KnownMesh{Paper::kEsvo, "Conference", 0x74cf0d0d230e6d4a, "", false, SceneState::kStandIn,
              "a furnished kitchen"},
    KnownMesh{Paper::kEsvo, "Hairball", 0, "hairball", false, SceneState::kStandIn,
              "a procedural hairball"},
    KnownMesh{Paper::kEsvo, "City", 0, "city", false, SceneState::kStandIn, "a procedural city"},
    KnownMesh{Paper::kEsvo, "Sibenik", 0, "courtyard", false, SceneState::kStandIn,
              "a procedural courtyard"},
    KnownMesh{Paper::kEsvo, "Sibenik-D", 0, "courtyard", true, SceneState::kStandIn,
              "a procedural courtyard, its surface displaced by stones"},
};

const PaperScene* scene_of(Paper paper, std::string_view name) {
  const auto* found = std::find_if(kScenes.begin(), kScenes.end(), [&](const PaperScene& scene) {
    return scene.paper == paper && scene.name == name;
  });
  return found == kScenes.end() ? nullptr : found;
}

/// Returns the letters in lower case: "San_Miguel.obj" holds "sanmiguel".
std::string letters_of(std::string_view name) {
  std::string letters;
  for (const char c : name)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0)
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters;
}

bool is_about(std::uint64_t count, std::uint64_t stated) {
  constexpr double kRounding = 0.04;
  const auto exact = static_cast<double>(stated);
  return stated != 0 && std::abs(static_cast<double>(count) - exact) <= kRounding * exact;
}

}  // namespace

std::string_view name_of(SceneState state) {
  switch (state) {
    case SceneState::kSame:
      return "same";
    case SceneState::kVariant:
      return "variant";
    case SceneState::kStandIn:
      break;
  }
  return "stand-in";
}

std::span<const PaperScene> paper_scenes() { return kScenes; }

std::string PaperMatch::label() const {
  if (scene == nullptr) return "";
  if (state == SceneState::kSame) return fmt::format("same as {}", scene->name);
  return fmt::format("{} {} {}: {}", name_of(state), state == SceneState::kVariant ? "of" : "for",
                     scene->name, difference);
}

std::string_view procedural_stand_in(const PaperScene& scene) {
  for (const KnownMesh& known : kKnown)
    if (known.paper == scene.paper && known.scene == scene.name && known.file_check == 0)
      return known.procedural_name;
  return "";
}

bool is_named_like(const PaperScene& scene, std::string_view mesh_name) {
  return letters_of(mesh_name).find(letters_of(scene.name)) != std::string::npos;
}

PaperMatch match_paper_scene(Paper paper, const MeshIdentity& mesh) {
  for (const KnownMesh& known : kKnown) {
    const bool is_it = known.procedural_name.empty()
                           ? !mesh.is_procedural && known.file_check == mesh.file_check
                           : mesh.is_procedural && known.procedural_name == mesh.name;
    if (is_it && known.paper == paper && known.is_displaced == mesh.is_displaced)
      return {scene_of(paper, known.scene), known.state, std::string(known.difference)};
  }
  if (mesh.is_procedural || mesh.is_displaced) return {};
  for (const PaperScene& scene : kScenes)
    if (scene.paper == paper && is_about(mesh.triangles, scene.triangles) &&
        is_named_like(scene, mesh.name))
      return {&scene, SceneState::kSame, ""};
  return {};
}

}  // namespace voxdag::lab
