#include "lab/reproduce/esvo/esvo_sections.hpp"

#include <gtest/gtest.h>

#include "lab/reproduce/esvo/esvo_pictures.hpp"

namespace voxdag::lab {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Returns what `bench esvo` prints for rays of one size.
OrderedJson rays_of(int width, int height, double triangles, double cubes, double contours,
                    double beams) {
  const auto rate = [](double mrays) {
    return OrderedJson{{"mrays_per_s", mrays}, {"cpu_mrays_per_s", nullptr}};
  };
  return {{"width", width},          {"height", height},           {"ray_count", 1'000'000},
          {"picture_seconds", 0.05}, {"filter_seconds", 0.002},    {"triangles", rate(triangles)},
          {"cubes", rate(cubes)},    {"contours", rate(contours)}, {"contours_beams", rate(beams)}};
}

SeriesRun run_at(int levels, OrderedJson json) {
  SeriesRun run;
  run.levels = levels;
  run.result.json = std::move(json);
  return run;
}

/// Returns Sibenik in this state, with octrees of 13 and 14 levels; the paper's has 14.
EsvoSceneRuns sibenik(SceneState state) {
  EsvoSceneRuns runs;
  for (const PaperScene& scene : paper_scenes())
    if (scene.name == "Sibenik") runs.scene.scene = &scene;
  runs.scene.match.scene = runs.scene.scene;
  runs.scene.match.state = state;
  runs.scene.mesh = "sibenik.obj";
  for (const int levels : {13, 14}) {
    runs.builds.push_back(run_at(
        levels,
        {{"bytes", {{"esvo", 60 << 20}}}, {"voxels", 10 << 20}, {"seconds", {{"build", 7.5}}}}));
    runs.rays.push_back(run_at(
        levels,
        {{"rays", {rays_of(1024, 768, 40, 25, 50, 55)}},
         {"silhouettes", {{{"cubes_wrong", 8e-4 / (levels - 12)}, {"contours_wrong", 5e-5}}}}}));
  }
  return runs;
}

std::string text_of(Section section) { return markdown_of({"", {std::move(section)}}); }

TEST(EsvoSections, AVariantStandsBesideThePaperAtEqualDepth) {
  const std::vector<EsvoSceneRuns> scenes{sibenik(SceneState::kVariant)};
  const std::string table1 = text_of(esvo_table1_section(scenes, 2));
  EXPECT_NE(table1.find("| Sibenik (variant) | MB | 60 | 60 |"), std::string::npos) << table1;
  EXPECT_NE(table1.find("|  | MB, published | 1,034 | 1,857 |"), std::string::npos) << table1;
  EXPECT_NE(table1.find("| 16K³ | 10.5 M | 6.00 | 16K³ | 5.68 |"), std::string::npos) << table1;
  const std::string table2 = text_of(esvo_table2_section(scenes));
  EXPECT_NE(table2.find("| 16K³ | 1024 × 768 | 40 (94) | 25 (46) | 50 (94) | 55 (104) |"),
            std::string::npos)
      << table2;
  EXPECT_EQ(table2.find("| 8K³ |"), std::string::npos) << table2;
}

TEST(EsvoSections, RatesOfAnotherDepthStandAlone) {
  EsvoSceneRuns runs = sibenik(SceneState::kVariant);
  runs.rays.pop_back();
  const std::string text = text_of(esvo_table2_section({runs}));
  EXPECT_NE(text.find("| 8K³ | 1024 × 768 | 40 | 25 | 50 | 55 |"), std::string::npos) << text;
}

TEST(EsvoSections, AStandInDoesNotStandBesideThePaper) {
  const std::vector<EsvoSceneRuns> scenes{sibenik(SceneState::kStandIn)};
  EXPECT_EQ(text_of(esvo_table1_section(scenes, 2)).find("MB, published"), std::string::npos);
  const std::string table2 = text_of(esvo_table2_section(scenes));
  EXPECT_NE(table2.find("| 16K³ | 1024 × 768 | 40 | 25 | 50 | 55 |"), std::string::npos) << table2;
  const std::string claims = text_of(esvo_claims_section(scenes));
  EXPECT_NE(claims.find("| 1.1 to 2.7 | – | not measured |"), std::string::npos) << claims;
}

TEST(EsvoSections, FilterAndShadingStandBesideTheCasts) {
  const std::string text = text_of(esvo_table2_section({sibenik(SceneState::kVariant)}));
  // A million rays at 55 million per second take 18 ms.
  EXPECT_NE(text.find("| 1024 × 768 | 18 ms | 50 ms | 2 ms | 9.1 |"), std::string::npos) << text;
}

TEST(EsvoSections, ClaimsAreJudgedByTheFinestOctrees) {
  const std::string text = text_of(esvo_claims_section({sibenik(SceneState::kVariant)}));
  EXPECT_NE(text.find("| 5.2 to 8.1 | 6 (Sibenik at 16K³) | reproduced |"), std::string::npos)
      << text;
  EXPECT_NE(text.find("| 1.1 to 2.7 | 2 (Sibenik at 16K³, 1024 × 768) | reproduced |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| 10 to 100 | 9.1 (Sibenik at 16K³, 1024 × 768) | not reproduced |"),
            std::string::npos)
      << text;
}

ScenePicture picture_of(const std::string& kind) {
  ScenePicture picture;
  picture.cell.output = kind + ".png";
  picture.cell.arguments = {"render", "picture.esvo", "--filter-kind", kind, "-o", kind + ".png"};
  return picture;
}

TEST(EsvoSections, LevelsAreSavedBesideCubesOfTheSameGridAndFinerOnes) {
  const auto saved = [](const std::vector<SilhouetteRow>& rows, std::size_t row) {
    const LevelsSaved levels = levels_saved(rows, rows[row]);
    return std::pair(levels.levels, levels.at_least);
  };
  const std::vector<SilhouetteRow> usual{
      {"a", 10, 8e-4, 1e-4}, {"a", 11, 4e-4, 5e-5}, {"a", 12, 2e-4, 2e-5}, {"a", 13, 1e-4, 1e-5}};
  EXPECT_EQ(saved(usual, 0), std::pair(3.0, false));
  EXPECT_EQ(saved(usual, 1), std::pair(2.0, true));
  EXPECT_EQ(saved(usual, 3), std::pair(0.0, true));
  // In a closed room hardly any ray misses: coarser cubes may have no wrong rays by chance.
  const std::vector<SilhouetteRow> room{{"b", 10, 0, 0}, {"b", 11, 7e-5, 9e-6}, {"b", 12, 0, 0}};
  EXPECT_EQ(saved(room, 0), std::pair(0.0, true));
  EXPECT_EQ(saved(room, 1), std::pair(1.0, false));
  EXPECT_EQ(saved(room, 2), std::pair(0.0, true));
  // Contours that are worse than the cubes of their grid.
  const std::vector<SilhouetteRow> worse{{"c", 10, 4e-4, 9e-4}, {"c", 11, 2e-4, 4e-4}};
  EXPECT_EQ(saved(worse, 1), std::pair(-1.0, false));
}

TEST(EsvoSections, FiltersStandSideBySide) {
  EsvoPictures pictures;
  pictures.filters = {picture_of("naive"), picture_of("plain")};
  pictures.guides = {picture_of("plain"), picture_of("guided")};
  const std::vector<Section> sections = esvo_picture_sections(pictures);
  ASSERT_EQ(sections.size(), 2u);
  const std::string figure10 = text_of(sections[0]), figure11 = text_of(sections[1]);
  for (const char* part : {"Figure 10: ", "naive.png", "plain.png",
                           "voxdag render picture.esvo --filter-kind plain -o plain.png"})
    EXPECT_NE(figure10.find(part), std::string::npos) << part << " in " << figure10;
  for (const char* part : {"Figure 11: ", "plain.png", "guided.png",
                           "voxdag render picture.esvo --filter-kind guided -o guided.png"})
    EXPECT_NE(figure11.find(part), std::string::npos) << part << " in " << figure11;
  pictures.guides[0].result.failure = "took too long";
  const std::string failed = text_of(esvo_picture_sections(pictures)[1]);
  EXPECT_NE(failed.find("No picture: took too long."), std::string::npos) << failed;
}

TEST(EsvoSections, ChartsHaveALineForEachFormAndResolution) {
  const std::vector<EsvoSceneRuns> scenes{sibenik(SceneState::kVariant)};
  const std::vector<Chart> rates = esvo_table2_charts(scenes);
  ASSERT_EQ(rates.size(), 1u);
  ASSERT_EQ(rates[0].panels.at(0).lines.size(), 4u);
  EXPECT_EQ(rates[0].panels[0].lines[0].x, (std::vector<double>{8192, 16384}));
  const std::vector<Chart> memory = esvo_table1_charts(scenes);
  ASSERT_EQ(memory.size(), 1u);
  EXPECT_EQ(memory[0].panels.at(0).lines.at(1).style, LineStyle::kDashed);
  const std::vector<Chart> errors = silhouettes_charts(scenes);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].panels.at(0).lines.at(1).y, (std::vector<double>{800, 400}));
  EXPECT_TRUE(esvo_table2_charts({}).empty());
}

}  // namespace
}  // namespace voxdag::lab
