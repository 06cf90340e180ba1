#include "lab/papers/paper_scenes.hpp"

#include <gtest/gtest.h>

namespace voxdag::lab {
namespace {

MeshIdentity file_named(const std::string& name, std::uint64_t triangles, std::uint64_t check = 1) {
  MeshIdentity mesh;
  mesh.name = name;
  mesh.triangles = triangles;
  mesh.file_check = check;
  return mesh;
}

TEST(PaperScenes, ATetrahedronNamedLucyIsNotLucy) {
  EXPECT_EQ(match_paper_scene(Paper::kSvdag, file_named("lucy.obj", 4)).scene, nullptr);
  EXPECT_EQ(match_paper_scene(Paper::kEsvo, file_named("sibenik.obj", 1)).scene, nullptr);
}

TEST(PaperScenes, TheNameAndTheTriangleCountOfThePaperAreTheScene) {
  const PaperMatch match = match_paper_scene(Paper::kSvdag, file_named("Lucy.ply", 28'055'742));
  ASSERT_NE(match.scene, nullptr);
  EXPECT_EQ(match.scene->name, "Lucy");
  EXPECT_EQ(match.state, SceneState::kSame);
  EXPECT_TRUE(match.has_figures());
  EXPECT_EQ(match.label(), "same as Lucy");
  const PaperMatch sponza =
      match_paper_scene(Paper::kSvdag, file_named("my_crysponza-2.obj", 279'163));
  ASSERT_NE(sponza.scene, nullptr);
  EXPECT_EQ(sponza.state, SceneState::kSame);
}

TEST(PaperScenes, AKnownFileIsRecognisedByItsContentUnderAnyName) {
  const PaperMatch match =
      match_paper_scene(Paper::kSvdag, file_named("scan.ply", 99'970, 0xfa0538188817d99b));
  ASSERT_NE(match.scene, nullptr);
  EXPECT_EQ(match.state, SceneState::kVariant);
  EXPECT_TRUE(match.has_figures());
  EXPECT_EQ(match.label(), "variant of Lucy: 99,970 triangles, 28 million in the paper");
}

TEST(PaperScenes, ADisplacedMeshIsAnotherScene) {
  MeshIdentity mesh = file_named("sibenik.obj", 80'479, 0x660b8c8b0c33e732);
  EXPECT_EQ(match_paper_scene(Paper::kEsvo, mesh).scene->name, "Sibenik");
  mesh.is_displaced = true;
  EXPECT_EQ(match_paper_scene(Paper::kEsvo, mesh).scene->name, "Sibenik-D");
}

TEST(PaperScenes, AProceduralSceneIsAStandInWithoutFigures) {
  MeshIdentity mesh;
  mesh.name = "hairball";
  mesh.is_procedural = true;
  mesh.triangles = 2'880'000;
  for (const Paper paper : {Paper::kSvdag, Paper::kEsvo}) {
    const PaperMatch match = match_paper_scene(paper, mesh);
    ASSERT_NE(match.scene, nullptr);
    EXPECT_EQ(match.state, SceneState::kStandIn);
    EXPECT_FALSE(match.has_figures());
    EXPECT_EQ(match.label(), "stand-in for Hairball: a procedural hairball");
  }
}

TEST(PaperScenes, EveryPaperHasItsTables) {
  int svdag = 0, esvo = 0;
  for (const PaperScene& scene : paper_scenes()) ++(scene.paper == Paper::kSvdag ? svdag : esvo);
  EXPECT_EQ(svdag, 5);
  EXPECT_EQ(esvo, 6);
}

}  // namespace
}  // namespace voxdag::lab
