#include "lab/reproduce/svdag/svdag_sections.hpp"

#include <gtest/gtest.h>

#include "lab/reproduce/svdag/flight.hpp"
#include "lab/reproduce/svdag/svdag_claims.hpp"

namespace voxdag::lab {
namespace {

/// Returns a scene that was built as a DAG at 2048³ only.
SvdagSceneBuilds scene_in_state(SceneState state) {
  SvdagSceneBuilds builds;
  for (const PaperScene& scene : paper_scenes())
    if (scene.name == "Lucy") builds.scene.scene = &scene;
  builds.scene.match.scene = builds.scene.scene;
  builds.scene.match.state = state;
  builds.scene.mesh = "lucy.ply";
  SeriesRun build;
  build.levels = 11;
  build.result.json = {{"dag_nodes", 1'500'000},
                       {"svo_nodes", 20'000'000},
                       {"voxels", 80'000'000},
                       {"bytes", {{"svdag_paper", 4 << 20}}},
                       {"bits_per_voxel", {{"svdag_paper", 0.42}, {"svo_pointerless", 2}}},
                       {"dag_nodes_per_level", {1, 8, 20}},
                       {"svo_nodes_per_level", {1, 8, 60}}};
  builds.dags = {build};
  return builds;
}

std::string table2_of(const SvdagSceneBuilds& scene) {
  return markdown_of({"", {table2_section({scene})}});
}

TEST(SvdagSections, AVariantStandsBesideThePaper) {
  const std::string text = table2_of(scene_in_state(SceneState::kVariant));
  EXPECT_NE(text.find("| Lucy (variant) | DAG | 1.5 |"), std::string::npos) << text;
  EXPECT_NE(text.find("|  | DAG, published | 1 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| Lucy (variant) | DAG | 4 |"), std::string::npos) << text;
  EXPECT_NE(text.find("|  | SVO | 20 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| 2K³ | 80.0 M | 0.42 | 2.00 | 64K³ | 1.54 | 2.57 |"), std::string::npos)
      << text;
}

TEST(SvdagSections, AStandInDoesNotStandBesideThePaper) {
  const std::string text = table2_of(scene_in_state(SceneState::kStandIn));
  EXPECT_NE(text.find("| Lucy (stand-in) | DAG | 1.5 |"), std::string::npos) << text;
  EXPECT_EQ(text.find("published |"), std::string::npos) << text;
}

TEST(SvdagSections, AnEsvoThatWasNotBuiltIsADashAndAReason) {
  SvdagSceneBuilds scene = scene_in_state(SceneState::kStandIn);
  SeriesRun failed;
  failed.levels = 11;
  failed.result.failure = "needs 9 GiB";
  scene.esvos = {failed};
  const std::string text = table2_of(scene);
  EXPECT_NE(text.find("|  | ESVO | – |"), std::string::npos) << text;
  EXPECT_NE(text.find("Lucy at 2K³: needs 9 GiB."), std::string::npos) << text;
}

TEST(SvdagSections, Figure5HasALineForEachDagAndOneForTheOctree) {
  const std::vector<Chart> charts = figure5_charts({scene_in_state(SceneState::kSame)});
  ASSERT_EQ(charts.size(), 1u);
  const std::vector<ChartLine>& lines = charts[0].panels.at(0).lines;
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].label, "DAG 2K³");
  EXPECT_EQ(lines[0].y, (std::vector<double>{1, 8, 20}));
  EXPECT_EQ(lines[1].label, "SVO");
  EXPECT_TRUE(figure5_charts({}).empty());
}

TEST(SvdagSections, ClaimsLookAtThePapersScenesOnly) {
  const auto claims_of = [](SceneState state) {
    return markdown_of({"", {svdag_claims_section({scene_in_state(state)}, std::nullopt)}});
  };
  const std::string variant = claims_of(SceneState::kVariant);
  EXPECT_NE(variant.find("| 576 at 64K³ | 13 (Lucy at 2K³) | not measured at 64K³ |"),
            std::string::npos)
      << variant;
  EXPECT_NE(
      variant.find("| 28 to 576 at the highest resolutions | 13 (Lucy at 2K³) | reproduced |"),
      std::string::npos)
      << variant;
  const std::string stand_in = claims_of(SceneState::kStandIn);
  EXPECT_NE(stand_in.find("| 576 at 64K³ | – | not measured |"), std::string::npos) << stand_in;
}

/// Returns rows of `bench trace` for two frames: voxdag's rates with those of a rival.
nlohmann::ordered_json rows_of(const char* rays, const char* rival, double rival_rate) {
  return {{"rays", rays},
          {"mrays_per_s", 20},
          {"view_mrays_per_s", {10, 30}},
          {"rival", rival},
          {"rival_mrays_per_s", rival_rate},
          {"rival_view_mrays_per_s", {rival_rate, rival_rate}},
          {"rival_agreement", 0.995}};
}

TEST(FlightSections, TheFasterOfARivalsCastsStandsBesideTheDag) {
  Flight flight;
  flight.scene = scene_in_state(SceneState::kVariant).scene;
  flight.with_triangles.levels = 15;
  flight.with_triangles.result.json = {rows_of("shadow", "embree_single", 10),
                                       rows_of("shadow", "embree_packet16", 40)};
  for (FlightRun* run :
       {&flight.with_esvo, &flight.with_voxels, &flight.with_cones, &flight.with_lamps})
    run->result.failure = "no memory";
  const std::string text = markdown_of({"", flight_sections(flight, false)});
  EXPECT_NE(text.find("**Shadow rays, Lucy (variant) at 32K³**"), std::string::npos) << text;
  EXPECT_NE(text.find("| triangles (Embree, on the processor) | 40 | 0.5 | 99.5 % |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Not measured: no memory."), std::string::npos) << text;
  const std::vector<Chart> charts = flight_charts(flight);
  ASSERT_EQ(charts.size(), 4u);
  const std::vector<ChartLine>& shadow = charts[1].panels.at(0).lines;
  EXPECT_EQ(shadow.at(0).y, (std::vector<double>{100, 1000.0 / 30}));  // ms for a million rays
  EXPECT_EQ(shadow.at(2).y, (std::vector<double>{25, 25}));
}

TEST(FlightSections, EmbreeComparesWithTheDagOnTheProcessor) {
  Flight flight;
  flight.scene = scene_in_state(SceneState::kVariant).scene;
  flight.with_triangles.result.json = {rows_of("shadow", "embree_single", 10),
                                       rows_of("shadow", "voxdag_cpu", 2)};
  for (FlightRun* run :
       {&flight.with_esvo, &flight.with_voxels, &flight.with_cones, &flight.with_lamps})
    run->result.failure = "no memory";
  const std::string text = markdown_of({"", flight_sections(flight, false)});
  EXPECT_NE(text.find("| DAG, on the processor | 2 | 10 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| triangles (Embree, on the processor) | 10 | 0.2 |"), std::string::npos)
      << text;
  EXPECT_EQ(speed_ratio(flight.with_triangles, "shadow", "embree"), 0.2);
}

}  // namespace
}  // namespace voxdag::lab
