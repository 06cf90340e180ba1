// Under mpirun, every rank runs every test; the checks of files are those of rank 0.
#include "voxdag/cluster/parts_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "parts_jobs.hpp"
#include "ranks_under_test.hpp"
#include "support/mesh_files.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/file/long_vdag_file.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/file/verify_vdag.hpp"
#include "voxdag/formats/scenes/ply_writer.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag {
namespace {

Mesh mesh_of(std::initializer_list<std::array<Vec3f, 3>> triangles) {
  Mesh mesh;
  for (const auto& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), t.begin(), t.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// 3,000 triangles in one voxel, of a grid that a far triangle sets.
Mesh crowd() {
  Mesh mesh = mesh_of({{{{0, 0, 0}, {1, 1, 1}, {1, 1, 0.999f}}}});
  std::mt19937_64 random(3);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back({0.25f + 1e-4f * static_cast<float>(random() % 10),
                               0.75f + 1e-4f * static_cast<float>(random() % 10), 0.5f});
    const std::uint32_t first = 3 + 3 * i;
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

std::vector<Scene> scenes() {
  const GridRequest elsewhere{.resolution = 64, .bounds = Box3d{{5, 5, 5}, {6, 6, 6}}},
      cut{9, std::nullopt, Box3d{{0.2, 0.1, 0.3}, {0.6, 0.5, 0.7}}},
      by_size{std::nullopt, 1.0 / 300, std::nullopt},
      unit{10, std::nullopt, Box3d{{0, 0, 0}, {1, 1, 1}}};
  std::vector<Scene> scenes;
  scenes.push_back({"courtyard", make_scene("courtyard", {.size = 0.1}), levels(8)});
  scenes.push_back({"hairball", make_scene("hairball", {.size = 5}), levels(8)});
  scenes.push_back({"huge", mesh_of({{{{0, 0, 0}, {1, 0.3f, 1}, {0.2f, 1, 0.9f}}}}), levels(9)});
  scenes.push_back({"crowd", crowd(), levels(8)});
  scenes.push_back({"empty", mesh_of({{{{0, 0, 0}, {1, 0.3f, 1}, {0.2f, 1, 0.9f}}}}), elsewhere});
  scenes.push_back({"random", random_mesh(300), levels(7)});
  scenes.push_back({"cut", make_scene("sponge", {.size = 3}), cut});
  scenes.push_back({"by_size", make_scene("sponge", {.size = 2}), by_size});
  // Corners beyond the integers of the grid: the triangle is clipped.
  scenes.push_back({"far", mesh_of({{{{9e6f, 0, 0}, {1, 0.3f, 1}, {0.2f, 1, 0.9f}}}}), unit});
  scenes.push_back({"leaf", random_mesh(3), levels(2)});
  scenes.push_back({"eight", random_mesh(9), levels(3)});
  return scenes;
}

class PartsJobScenes : public testing::TestWithParam<std::size_t> {
 protected:
  static const Scene& scene(std::size_t index) {
    static const std::vector<Scene> all = scenes();
    return all[index];
  }
};

TEST_P(PartsJobScenes, GiveTheFileOfAPlainBuild) {
  const Scene& scene = this->scene(GetParam());
  const SharedFolder folder(ranks());
  if (ranks().rank() == 0) {
    write_ply(folder / "scene.ply", scene.mesh);
    build_plainly(folder / "scene.ply", scene.grid, folder / "plain.vdag");
  }
  ranks().barrier();
  const std::vector<std::uint64_t> counts = ranks().count() == 1
                                                ? std::vector<std::uint64_t>{0, 1, 3, 100}
                                                : std::vector<std::uint64_t>{7};
  for (const std::uint64_t parts : counts) {
    MemoryBudget unlimited;
    const PartsReport report =
        build_in_parts(job_of(folder, scene, parts), kProgram, ranks(), &unlimited);
    EXPECT_EQ(report.parts, report.built);
    if (ranks().rank() != 0) continue;
    EXPECT_EQ(read_text(folder / "parts.vdag"), read_text(folder / "plain.vdag")) << parts;
    // Nothing but the log is left.
    EXPECT_FALSE(std::filesystem::exists(folder / "work" / "job.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "work" / "parts"));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PartsJobScenes, testing::Range<std::size_t>(0, scenes().size()),
                         [](const auto& tested) { return scenes()[tested.param].name; });

/// A mesh file that the ranks read in chunks, or that rank 0 reads alone.
struct MeshFile {
  const char* name;
  std::string text;
};

std::vector<MeshFile> mesh_files() {
  std::string far = random_obj(400, "\n");  // far from 0 along x
  for (std::size_t at = 0; (at = far.find("v 0.", at)) != far.npos;)
    far.replace(at, 3, "v 4649776");
  return {{"polygons.obj", random_obj(400, "\n")},
          {"far.obj", far},
          {"far.off", "OFF\n3 1 0\n0 4649776.1 0\n1 4649776.1 0\n0 4649776.9 0.5\n3 0 1 2\n"},
          {"triangles.ply", random_ply(600, false, 3)},
          {"big_endian.ply", random_ply(600, true, 3)},
          {"quads.ply", random_ply(300, false, 4)},
          {"facets.stl", random_stl(500)},
          {"mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n"}};
}

class PartsJobFiles : public testing::TestWithParam<std::size_t> {};

TEST_P(PartsJobFiles, GiveTheFileOfAPlainBuild) {
  const MeshFile file = mesh_files()[GetParam()];
  const SharedFolder folder(ranks());
  PartsJob job = {folder / file.name, folder / "work", folder / "parts.vdag", levels(7), 3, {}};
  job.chunk_bytes = 64;  // the ranks share several tasks of the file
  if (ranks().rank() == 0) {
    write_text(job.mesh, file.text);
    build_plainly(job.mesh, job.grid, folder / "plain.vdag");
  }
  ranks().barrier();
  // In all memory, and in little.
  for (const std::uint64_t limit : {std::uint64_t{1} << 40, std::uint64_t{24} << 20}) {
    MemoryBudget budget(limit);
    build_in_parts(job, kProgram, ranks(), &budget);
    if (ranks().rank() != 0) continue;
    EXPECT_EQ(read_text(folder / "parts.vdag"), read_text(folder / "plain.vdag"));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, PartsJobFiles, testing::Range<std::size_t>(0, mesh_files().size()),
                         [](const auto& tested) {
                           std::string name = mesh_files()[tested.param].name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST(PartsJob, ADagOfTooManyWordsGetsLongPointers) {
  const SharedFolder folder(ranks());
  const Scene scene{"courtyard", make_scene("courtyard", {.size = 0.1}), levels(8)};
  PartsJob job = job_of(folder, scene, 5);
  if (ranks().rank() == 0) {
    write_ply(job.mesh, scene.mesh);
    build_plainly(job.mesh, scene.grid, folder / "plain.vdag");
  }
  ranks().barrier();
  MemoryBudget unlimited;
  job.most_plain_words = 1000;  // instead of some 2^32
  build_in_parts(job, kProgram, ranks(), &unlimited);
  if (ranks().rank() != 0) return;
  ASSERT_EQ(vdag_kind(job.output), VdagKind::kLong);
  EXPECT_TRUE(verify_vdag(job.output).passed());
  const LongVdagFile file(job.output);
  const VdagFile plain(folder / "plain.vdag");
  EXPECT_EQ(file.metadata().counts, plain.metadata().counts);
  const Svdag all = crop(file.view(), {{0, 0, 0}, {256, 256, 256}});
  EXPECT_EQ(all, crop(plain.view(), {{0, 0, 0}, {256, 256, 256}}));
}

TEST(PartsJob, SplitsPartsThatDoNotFitIntoMemory) {
  const SharedFolder folder(ranks());
  const Scene scene{"courtyard", make_scene("courtyard", {.size = 0.2}), levels(10)};
  if (ranks().rank() == 0) {
    write_ply(folder / "scene.ply", scene.mesh);
    build_plainly(folder / "scene.ply", scene.grid, folder / "plain.vdag");
  }
  ranks().barrier();
  // The plain build needs more: see the sizes of its nodes and tables.
  // Several ranks also hold messages.
  const std::uint64_t limit = std::uint64_t{ranks().count() == 1 ? 12u : 32u} << 20;
  MemoryBudget little(limit);
  const PartsReport report = build_in_parts(job_of(folder, scene, 1), kProgram, ranks(), &little);
  EXPECT_EQ(report.parts, 1u);
  EXPECT_LE(little.peak(), limit);
  if (ranks().count() == 1) {
    EXPECT_GT(report.mailboxes, 1u);
  }
  if (ranks().rank() != 0) return;
  EXPECT_EQ(read_text(folder / "parts.vdag"), read_text(folder / "plain.vdag"));
}

}  // namespace
}  // namespace voxdag
