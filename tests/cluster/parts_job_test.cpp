// Under mpirun, every rank runs every test; the checks of files are those of rank 0.
#include "voxdag/cluster/parts_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "ranks_under_test.hpp"
#include "shared_folder.hpp"
#include "support/error_of.hpp"
#include "support/file_size_limit.hpp"
#include "support/mesh_files.hpp"
#include "support/random_triangles.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/dag/build_svdag.hpp"
#include "voxdag/file/long_vdag_file.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/file/verify_vdag.hpp"
#include "voxdag/layout/svdag_counts.hpp"
#include "voxdag/readers/read_mesh.hpp"
#include "voxdag/scenes/ply_writer.hpp"
#include "voxdag/scenes/scenes.hpp"

namespace voxdag {
namespace {

constexpr const char* kProgram = "a test";

struct Scene {
  const char* name;
  Mesh mesh;
  GridRequest grid;
};

GridRequest levels(int levels) { return {levels, std::nullopt, std::nullopt}; }

Mesh mesh_of(std::initializer_list<std::array<Vec3f, 3>> triangles) {
  Mesh mesh;
  for (const auto& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), t.begin(), t.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Mesh random_mesh(int count) {
  std::mt19937_64 random(7);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const QuantizedTriangle t = random_triangle(random, 7);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(static_cast<Vec3f>(t[corner]));
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
  const GridRequest elsewhere{6, std::nullopt, Box3d{{5, 5, 5}, {6, 6, 6}}},
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

/// Writes the file of a plain build.
void build_plainly(const std::filesystem::path& mesh_file, const GridRequest& request,
                   const std::filesystem::path& output) {
  const Mesh mesh = read_mesh(mesh_file);
  VdagMetadata metadata;
  metadata.grid = grid_for(mesh, request);
  metadata.source = {mesh_file.filename().string(), mesh.vertices.size(), mesh.triangles.size()};
  metadata.program = kProgram;
  metadata.build = settings_of(request);
  const Svdag dag = build_svdag(mesh, metadata.grid).dag;
  metadata.counts = count_svdag(dag.view());
  write_vdag(output, dag.view(), metadata);
}

PartsJob job_of(const SharedFolder& folder, const Scene& scene, std::uint64_t parts) {
  return {folder / "scene.ply", folder / "work", folder / "parts.vdag", scene.grid, parts, {}};
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
    write_ply(folder / "scene.ply", scene.mesh, nullptr);
    build_plainly(folder / "scene.ply", scene.grid, folder / "plain.vdag");
  }
  ranks().barrier();
  const std::vector<std::uint64_t> counts = ranks().count() == 1
                                                ? std::vector<std::uint64_t>{0, 1, 3, 100}
                                                : std::vector<std::uint64_t>{7};
  for (const std::uint64_t parts : counts) {
    MemoryBudget unlimited;
    const PartsReport report =
        build_in_parts(job_of(folder, scene, parts), kProgram, ranks(), unlimited, nullptr);
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
  return {{"polygons.obj", random_obj(400, "\n")},
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
    build_in_parts(job, kProgram, ranks(), budget, nullptr);
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
    write_ply(job.mesh, scene.mesh, nullptr);
    build_plainly(job.mesh, scene.grid, folder / "plain.vdag");
  }
  ranks().barrier();
  MemoryBudget unlimited;
  job.most_plain_words = 1000;  // instead of some 2^32
  build_in_parts(job, kProgram, ranks(), unlimited, nullptr);
  if (ranks().rank() != 0) return;
  ASSERT_TRUE(has_long_pointers(job.output));
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
    write_ply(folder / "scene.ply", scene.mesh, nullptr);
    build_plainly(folder / "scene.ply", scene.grid, folder / "plain.vdag");
  }
  ranks().barrier();
  // The plain build needs more: see the sizes of its nodes and tables.
  // Several ranks also hold messages.
  const std::uint64_t limit = std::uint64_t{ranks().count() == 1 ? 12u : 32u} << 20;
  MemoryBudget little(limit);
  const PartsReport report =
      build_in_parts(job_of(folder, scene, 1), kProgram, ranks(), little, nullptr);
  EXPECT_EQ(report.parts, 1u);
  EXPECT_LE(little.peak(), limit);
  if (ranks().count() == 1) {
    EXPECT_GT(report.mailboxes, 1u);
  }
  if (ranks().rank() != 0) return;
  EXPECT_EQ(read_text(folder / "parts.vdag"), read_text(folder / "plain.vdag"));
}

/// A job of one process that ends early. Under mpirun, these tests are skipped: a rank that fails
/// ends all others.
class PartsJobFailures : public testing::Test {
 protected:
  void SetUp() override {
    if (ranks().count() > 1) GTEST_SKIP() << "for one process";
    folder_.emplace(ranks());
    write_ply(*folder_ / "scene.ply", scene_.mesh, nullptr);
    build_plainly(*folder_ / "scene.ply", scene_.grid, *folder_ / "plain.vdag");
    plain_ = read_text(*folder_ / "plain.vdag");
  }

  /// Runs the job; cancels it at its `reports`-th report. Returns whether it came to its end.
  bool run(int reports) {
    int left = reports;
    Progress* to_cancel = nullptr;
    Progress progress([&](std::string_view, double, std::uint64_t) {
      if (left-- == 0) to_cancel->cancel();
    });
    to_cancel = &progress;
    MemoryBudget unlimited;
    try {
      report_ =
          build_in_parts(job_of(*folder_, scene_, 5), kProgram, ranks(), unlimited, &progress);
      return true;
    } catch (const Cancelled&) {
      return false;
    }
  }
  std::filesystem::path work() const { return *folder_ / "work"; }
  std::string output() const { return read_text(*folder_ / "parts.vdag"); }

  const Scene scene_{"random", random_mesh(60), levels(6)};
  std::optional<SharedFolder> folder_;
  std::string plain_;
  PartsReport report_;
};

constexpr int kNever = 1 << 30;

TEST_F(PartsJobFailures, AJobThatEndedEarlyGoesOn) {
  bool has_skipped_parts = false;
  for (int reports = 0; !run(reports); ++reports) {
    EXPECT_FALSE(std::filesystem::exists(*folder_ / "parts.vdag")) << reports;
    ASSERT_TRUE(run(kNever)) << reports;
    has_skipped_parts |= report_.built < report_.parts;
    EXPECT_EQ(output(), plain_) << reports;
    EXPECT_FALSE(std::filesystem::exists(work() / "parts")) << reports;
    std::filesystem::remove(*folder_ / "parts.vdag");
  }
  EXPECT_TRUE(has_skipped_parts);
}

TEST_F(PartsJobFailures, AJobThatEndsAgainAndAgainComesToItsEnd) {
  int runs = 1;
  while (!run(8)) ASSERT_LT(++runs, 20);
  EXPECT_GT(runs, 2);
  EXPECT_EQ(output(), plain_);
}

TEST_F(PartsJobFailures, DamagedAndLostFilesAreMadeAnew) {
  int all_reports = 0;
  while (!run(all_reports)) std::filesystem::remove_all(work()), ++all_reports;
  std::mt19937_64 random(5);
  for (const int reports :
       {all_reports / 4, all_reports / 2, all_reports * 3 / 4, all_reports - 1}) {
    for (int kind = 0; kind < 8; ++kind) {
      ASSERT_FALSE(run(reports));
      std::vector<std::filesystem::path> files;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(work()))
        if (entry.is_regular_file() && entry.path().filename() != "job.json")
          files.push_back(entry.path());
      std::sort(files.begin(), files.end());
      // Several files, each in another way.
      for (int i = 0; i < 3; ++i) {
        const std::filesystem::path& file = files[random() % files.size()];
        std::string bytes = read_text(file);
        if (bytes.empty() || kind % 3 == 0) {
          std::filesystem::remove(file);
        } else if (kind % 3 == 1) {
          write_text(file, bytes.substr(0, random() % bytes.size()));
        } else {
          bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
          write_text(file, bytes);
        }
      }
      int errors = 0;
      for (bool is_done = false; !is_done && errors < 4;) {
        const std::string error = error_of([&] { is_done = run(kNever); });
        if (is_done) break;
        ++errors;
        EXPECT_NE(error.find("same command again"), std::string::npos) << error;
      }
      EXPECT_LE(errors, 1);
      EXPECT_EQ(output(), plain_) << reports << " " << kind;
    }
  }
}

TEST_F(PartsJobFailures, AFullDiskEndsTheJobInAnyStepAndTheNextRunGoesOn) {
  int failures = 0;
  for (std::uint64_t bytes = 64; bytes < (std::uint64_t{1} << 22); bytes += bytes / 8) {
    std::string error;
    bool is_done = false;
    {
      const FileSizeLimit limit(bytes);
      try {
        is_done = run(kNever);
      } catch (const Error& full) {
        error = full.what();
      }
    }
    if (is_done) break;
    ++failures;
    // One line names a file of the job and the system's reason.
    EXPECT_NE(error.find("File too large"), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_FALSE(std::filesystem::exists(*folder_ / "parts.vdag")) << bytes;
    if (failures % 3 == 0) {  // else the next run begins with what is there
      ASSERT_TRUE(run(kNever)) << bytes;
      EXPECT_EQ(output(), plain_) << bytes;
      std::filesystem::remove(*folder_ / "parts.vdag");
    }
  }
  EXPECT_GT(failures, 20);
  EXPECT_EQ(output(), plain_);
  for (const auto& entry : std::filesystem::directory_iterator(folder_->path()))
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
}

TEST_F(PartsJobFailures, AJobGoesOnWithOtherMemory) {
  const Scene scene{"courtyard", make_scene("courtyard", {.size = 0.5}), levels(7)};
  write_ply(*folder_ / "scene.ply", scene.mesh, nullptr);
  build_plainly(*folder_ / "scene.ply", scene.grid, *folder_ / "plain.vdag");
  const PartsJob job = job_of(*folder_, scene, 5);
  // Segments of a smaller budget have fewer triangles. Cancels at each report in turn.
  for (const int reports : {3, 4, 6, 9}) {
    int left = reports;
    Progress* to_cancel = nullptr;
    Progress progress([&](std::string_view, double, std::uint64_t) {
      if (left-- == 0) to_cancel->cancel();
    });
    to_cancel = &progress;
    MemoryBudget little(std::uint64_t{12} << 20), more(std::uint64_t{64} << 20);
    EXPECT_THROW(build_in_parts(job, kProgram, ranks(), little, &progress), Cancelled);
    // A job without facts about the mesh, but with segments.
    if (reports % 2 == 0) std::filesystem::remove(work() / "triangles" / "mesh");
    build_in_parts(job, kProgram, ranks(), more, nullptr);
    EXPECT_EQ(output(), read_text(*folder_ / "plain.vdag")) << reports;
  }
}

TEST_F(PartsJobFailures, AFolderOfAnotherJobIsRefused) {
  ASSERT_FALSE(run(3));
  MemoryBudget unlimited;
  PartsJob job = job_of(*folder_, scene_, 5);
  const auto error = [&] {
    return error_of([&] { build_in_parts(job, kProgram, ranks(), unlimited, nullptr); });
  };
  job.grid.levels = 7;
  EXPECT_EQ(error(), work().string() +
                         ": the folder belongs to a job with another resolution: 64, not 128; give "
                         "the same options, or another folder");
  job = job_of(*folder_, scene_, 6);
  EXPECT_NE(error().find("another number of parts: 5, not 6"), std::string::npos) << error();
  job = job_of(*folder_, scene_, 5);
  Mesh moved = scene_.mesh;
  moved.vertices[0].x += 1;
  write_ply(*folder_ / "scene.ply", moved, nullptr);
  EXPECT_NE(error().find("another content of the mesh"), std::string::npos) << error();
}

TEST_F(PartsJobFailures, AFolderOfOtherFilesIsRefused) {
  std::filesystem::create_directory(work());
  write_text(work() / "thesis.txt", "chapter 1");
  EXPECT_EQ(error_of([&] { run(kNever); }),
            work().string() + ": the folder holds other files; give an empty one, or a new name");
  EXPECT_EQ(read_text(work() / "thesis.txt"), "chapter 1");
}

TEST_F(PartsJobFailures, AFolderInUseIsRefused) {
  const WorkFolder other(work(), {}, true);
  EXPECT_EQ(error_of([&] { run(kNever); }),
            work().string() + ": another job is working in this folder");
}

TEST_F(PartsJobFailures, AVertexThatIsNotFiniteIsTheErrorOfReadMesh) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\n";
  for (int i = 0; i < 3000; ++i) text += "f 1 2 3\n";
  PartsJob job = job_of(*folder_, scene_, 5);
  job.mesh = *folder_ / "scene.obj";
  job.chunk_bytes = 64;
  MemoryBudget unlimited;
  write_text(job.mesh, text);  // an unused vertex may be anything
  build_in_parts(job, kProgram, ranks(), unlimited, nullptr);
  write_text(job.mesh, text + "f 2 3 4\n");
  EXPECT_EQ(error_of([&] { build_in_parts(job, kProgram, ranks(), unlimited, nullptr); }),
            error_of([&] { read_mesh(job.mesh); }));
}

TEST_F(PartsJobFailures, AnErrorOfTheMeshIsReported) {
  write_text(*folder_ / "scene.ply", "ply\nformat ascii 1.0\nend_header\n");
  EXPECT_NE(error_of([&] { run(kNever); }).find("scene.ply"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "parts.vdag"));
}

}  // namespace
}  // namespace voxdag
