// Jobs that end early, and the runs that go on with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "parts_jobs.hpp"
#include "ranks_under_test.hpp"
#include "support/error_of.hpp"
#include "support/file_size_limit.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/formats/scenes/ply_writer.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag {
namespace {

/// A job of one process that ends early. Under mpirun, these tests are skipped: a rank that fails
/// ends all others.
class PartsJobFailures : public testing::Test {
 protected:
  void SetUp() override {
    if (ranks().count() > 1) GTEST_SKIP() << "for one process";
    folder_.emplace(ranks());
    write_ply(*folder_ / "scene.ply", scene_.mesh);
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
          build_in_parts(job_of(*folder_, scene_, 5), kProgram, ranks(), {&unlimited, &progress});
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
  write_ply(*folder_ / "scene.ply", scene.mesh);
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
    EXPECT_THROW(build_in_parts(job, kProgram, ranks(), {&little, &progress}), Cancelled);
    // A job without facts about the mesh, but with segments.
    if (reports % 2 == 0) std::filesystem::remove(work() / "triangles" / "mesh");
    build_in_parts(job, kProgram, ranks(), &more);
    EXPECT_EQ(output(), read_text(*folder_ / "plain.vdag")) << reports;
  }
}

TEST_F(PartsJobFailures, AFolderOfAnotherJobIsRefused) {
  ASSERT_FALSE(run(3));
  MemoryBudget unlimited;
  PartsJob job = job_of(*folder_, scene_, 5);
  const auto error = [&] {
    return error_of([&] { build_in_parts(job, kProgram, ranks(), &unlimited); });
  };
  job.grid.resolution = 128;
  EXPECT_EQ(error(), work().string() +
                         ": the folder belongs to a job with another resolution: 64, not 128; give "
                         "the same options, or another folder");
  job = job_of(*folder_, scene_, 6);
  EXPECT_NE(error().find("another number of parts: 5, not 6"), std::string::npos) << error();
  job = job_of(*folder_, scene_, 5);
  Mesh moved = scene_.mesh;
  moved.vertices[0].x += 1;
  write_ply(*folder_ / "scene.ply", moved);
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

TEST_F(PartsJobFailures, TrianglesWithAVertexThatIsNotFiniteAreLeftOut) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\n";
  for (int i = 0; i < 3000; ++i) text += "f 1 2 3\n";
  PartsJob job = job_of(*folder_, scene_, 5);
  job.mesh = *folder_ / "scene.obj";
  job.chunk_bytes = 64;
  MemoryBudget unlimited;
  write_text(job.mesh, text);  // an unused vertex may be anything
  EXPECT_EQ(build_in_parts(job, kProgram, ranks(), &unlimited).bad_triangles, 0u);
  write_text(job.mesh, text + "f 2 3 4\n");
  const PartsReport report = build_in_parts(job, kProgram, ranks(), &unlimited);
  EXPECT_EQ(report.bad_triangles, 1u);
  EXPECT_EQ(report.metadata.source.triangles, 3000u);
  write_text(job.mesh, "v 0 0 0\nv 1 0 0\nv nan 0 0\nf 1 2 3\n");
  EXPECT_EQ(error_of([&] { build_in_parts(job, kProgram, ranks(), &unlimited); }),
            error_of([&] { read_mesh(job.mesh); }));
}

TEST_F(PartsJobFailures, AnErrorOfTheMeshIsReported) {
  write_text(*folder_ / "scene.ply", "ply\nformat ascii 1.0\nend_header\n");
  EXPECT_NE(error_of([&] { run(kNever); }).find("scene.ply"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "parts.vdag"));
}

}  // namespace
}  // namespace voxdag
