#pragma once
/// The scenes of both papers, and which of them a mesh is: a published figure stands beside a
/// measured one only for the same scene, or for a variant that is labelled as one.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace voxdag::lab {

/// XXH3-64 of the mesh files of real scenes.
inline constexpr std::uint64_t kCrytekSponzaCheck = 0xd5d755a4c62db15e,
                               kSanMiguelCoreCheck = 0x1b139a913bd76b81,
                               kLucyCheck = 0xfa0538188817d99b, kSibenikCheck = 0x660b8c8b0c33e732;

enum class Paper {
  kSvdag,  ///< Kämpe, Sintorn, Assarsson 2013.
  kEsvo,   ///< Laine, Karras 2010.
};

/// How a mesh differs from a paper's scene.
enum class SceneState {
  kSame,     ///< The paper's model with the paper's number of triangles.
  kVariant,  ///< The paper's model in another version: fewer triangles, other displacement.
  kStandIn,  ///< Another model of the same kind. No published figure belongs beside it.
};

/// Returns "same", "variant" or "stand-in".
std::string_view name_of(SceneState state);

struct PaperScene {
  Paper paper;
  std::string_view name;    ///< As in the paper's tables.
  std::uint64_t triangles;  ///< As the paper says, rounded; 0: it does not say.
};

/// Returns the scenes of both papers' tables, in the order of the tables.
std::span<const PaperScene> paper_scenes();

/// What is known of a mesh that is measured.
struct MeshIdentity {
  std::string name;              ///< The name of its file or of its procedural scene.
  bool is_procedural = false;    ///< A scene of `voxdag scene`.
  bool is_displaced = false;     ///< Built with a height texture for all materials.
  std::uint64_t triangles = 0;   ///< As read.
  std::uint64_t file_check = 0;  ///< XXH3-64 of the file.
};

/// The paper's scene that a mesh stands for.
struct PaperMatch {
  const PaperScene* scene = nullptr;  ///< Null: none.
  SceneState state = SceneState::kStandIn;
  std::string difference;  ///< From the paper's scene, in words; empty if it is the same.

  /// Returns whether the scene's published figures may stand beside measured ones.
  bool has_figures() const { return scene != nullptr && state != SceneState::kStandIn; }
  /// Returns "same as Lucy", or "variant of Lucy: 99,970 triangles, 28 million in the paper"; empty
  /// without a scene.
  std::string label() const;
};

/// Returns the name of the procedural scene that can stand in for a paper's scene; empty: none.
std::string_view procedural_stand_in(const PaperScene& scene);

/// Returns whether a mesh of this name may be the scene: its name has the scene's name in it.
bool is_named_like(const PaperScene& scene, std::string_view mesh_name);

/// Returns the scene of `paper` that the mesh stands for. Known files are recognised by their
/// content. Others are the same as a scene if their name has the scene's name in it and their
/// number of triangles is the paper's, within the 4 % by which the papers round.
PaperMatch match_paper_scene(Paper paper, const MeshIdentity& mesh);

}  // namespace voxdag::lab
