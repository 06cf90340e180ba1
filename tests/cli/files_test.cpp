/// Tests of files: inputs are kept, outputs may be pipes or descriptors, names may have any bytes.
#include <sys/stat.h>

#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "npy_rays.hpp"
#include "sponge.hpp"

namespace voxdag::cli {
namespace {

using Words = std::vector<std::string>;

class Files : public Sponge {
 protected:
  static Words build_to(const std::string& output) {
    return {"build", path("sponge.ply"), "-r", "16", "-q", "-o", output};
  }
  /// Runs a shell command in which $V is the program and $IN the mesh.
  static ProcessResult shell(const std::string& text) {
    return Process({"bash", "-c",
                    "V='" + voxdag_command({})[0] + "' IN='" + path("sponge.ply") + "'; cd '" +
                        path(".") + "' || exit; " + text})
        .wait();
  }
  /// Copies a file and returns its contents.
  static std::string copy(const std::string& from, const std::string& to) {
    write_text(path(to), read_text(path(from)));
    return read_text(path(to));
  }
};

TEST_F(Files, FilesThatTheMeshNamesAreNotOverwritten) {
  write_text(path("a.obj"), "mtllib a.esvo\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  write_text(path("a.esvo"), "newmtl m\nmap_Kd a.png\n");
  write_text(path("a.png"), "no picture");
  for (const char* named : {"a.esvo", "a.png"}) {
    const std::string before = read_text(path(named));
    expect_failure(run_voxdag({"build", path("a.obj"), "-r", "16", "-o", path(named)}), 1,
                   "--output would overwrite this file, which " + path("a.obj") + " names");
    EXPECT_EQ(read_text(path(named)), before);
  }
}

TEST_F(Files, InputsAreNotOverwritten) {
  const std::string mesh = copy("sponge.ply", "a.ply"), dag = copy("in.vdag", "a.png");
  write_text(path("rays.npy"), rays_npy({{0, 9, 0, 0, 0, -1, 0, 1}}));
  const std::string rays = read_text(path("rays.npy"));
  write_text(path("keys.json"), R"({"keys": [{"time": 0, "eye": [2,1,2], "target": [0,0,0]}]})");
  const std::string keys = read_text(path("keys.json"));
  copy("in.vdag", "b.npy.json");
  std::filesystem::create_hard_link(path("a.ply"), path("hard.ply"));
  std::filesystem::create_symlink("a.ply", path("soft.ply"));
  for (const char* output : {"a.ply", "hard.ply", "soft.ply"})
    expect_failure(run_voxdag({"build", path("a.ply"), "-r", "16", "-o", path(output)}), 2,
                   "an input file");
  expect_failure(run_voxdag({"render", path("a.png"), "-o", path("a.png")}), 2, "an input file");
  expect_failure(
      run_voxdag({"trace", path("in.vdag"), "--rays", path("rays.npy"), "-o", path("rays.npy")}), 2,
      "an input file");
  expect_failure(run_voxdag({"render", path("in.vdag"), "--path", path("keys.json"), "-o",
                             path("f%d.png"), "--timings", path("keys.json")}),
                 2, "an input file");
  expect_failure(run_voxdag({"export", path("b.npy.json"), "-o", path("b.npy")}), 2,
                 "an input file");
  copy("in.vdag", "f0.png");
  expect_failure(run_voxdag({"render", path("f0.png"), "--path", path("keys.json"), "-o",
                             path("f%d.png"), "--size", "16x9"}),
                 1, "f0.png");
  EXPECT_EQ(read_text(path("a.ply")), mesh);
  EXPECT_EQ(read_text(path("a.png")), dag);
  EXPECT_EQ(read_text(path("f0.png")), dag);
  EXPECT_EQ(read_text(path("rays.npy")), rays);
  EXPECT_EQ(read_text(path("keys.json")), keys);
  EXPECT_EQ(read_text(path("b.npy.json")), dag);
}

TEST_F(Files, DanglingLinksCountAsTheFileTheyPointTo) {
  std::filesystem::create_symlink("d.png", path("link.png"));
  expect_failure(run_voxdag({"render", path("in.vdag"), "-o", path("link.png"), "--depth",
                             path("d.png"), "--size", "16x9"}),
                 2, "would overwrite");
  std::filesystem::create_symlink("g1.png", path("g0.png"));
  write_text(path("k.json"), R"({"keys": [{"time": 0, "eye": [2,1,2], "target": [0,0,0]},
                                          {"time": 1, "eye": [2,2,2], "target": [0,0,0]}]})");
  expect_failure(run_voxdag({"render", path("in.vdag"), "--path", path("k.json"), "--fps", "2",
                             "-o", path("g%d.png"), "--size", "16x9"}),
                 1, "two files of the film have this name");
}

TEST_F(Files, StandardOutputIsWrittenFromItsPosition) {
  ASSERT_EQ(run_voxdag(build_to(path("plain.vdag"))).status, 0);
  const std::string dag = read_text(path("plain.vdag"));
  for (const char* name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    const std::string build = std::string("$V build $IN -r 16 -q -o ") + name;
    EXPECT_EQ(shell("{ echo head; " + build + "; echo tail; } > out").status, 0);
    EXPECT_EQ(read_text(path("out")), "head\n" + dag + "tail\n") << name;
    EXPECT_EQ(shell(build + " | cat > out").status, 0);
    EXPECT_EQ(read_text(path("out")), dag) << name;
  }
  expect_failure(shell("$V build $IN -r 16 -q -o /dev/fd/77"), 1, "/dev/fd/77: cannot write");
  expect_failure(shell("$V build $IN -r 16 -q -o /dev/stdin < out"), 1, "/dev/stdin");
  const bool is_link = std::filesystem::is_symlink("/dev/stdout");
  expect_failure(shell("$V build $IN -r 16 -q -o /dev/stdout >&-"), 1, "/dev/stdout");
  EXPECT_EQ(std::filesystem::is_symlink("/dev/stdout"), is_link);
  expect_failure(shell("$V build $IN -r 16 -q --as esvo -o /dev/stdout 3>out"), 1, "regular file");
}

TEST_F(Files, APipeIsOpenedOnce) {
  ASSERT_EQ(run_voxdag(build_to(path("plain.vdag"))).status, 0);
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  ASSERT_EQ(shell("timeout 60 cat pipe > read & $V build $IN -r 16 -q -o pipe; wait").status, 0);
  EXPECT_EQ(read_text(path("read")), read_text(path("plain.vdag")));
}

TEST_F(Files, WaitingForAPipesReaderCanBeInterrupted) {
  ASSERT_EQ(mkfifo(path("alone").c_str(), 0600), 0);
  Process waiting(voxdag_command(build_to(path("alone"))));
  waiting.wait_until_it_catches(SIGTERM);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  waiting.send_signal(SIGTERM);
  expect_failure(waiting.wait(), 128 + SIGTERM, "cancelled");
}

TEST_F(Files, ALongVerificationCanBeInterrupted) {
  ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "16", "-o", path("in.esvo")}).status, 0);
  for (const char* scene : {"in.vdag", "in.esvo"}) {
    Process verifying(voxdag_command(
        {"verify", path(scene), "--mesh", path("sponge.ply"), "--samples", "1000000000"}));
    EXPECT_TRUE(verifying.wait_until_it_warns("the check of 1,000,000,000 samples takes about"));
    verifying.send_signal(SIGTERM);
    const ProcessResult result = verifying.wait();
    EXPECT_EQ(result.status, 128 + SIGTERM);
    EXPECT_NE(result.err.find("cancelled"), std::string::npos) << result.err;
  }
}

TEST_F(Files, NamesMayHaveAnyBytes) {
  copy("sponge.ply", "\xff.ply");
  const ProcessResult built =
      run_voxdag({"build", path("\xff.ply"), "-r", "16", "--json", "-o", path("named.vdag")});
  EXPECT_EQ(built.status, 0) << built.err;
  EXPECT_TRUE(nlohmann::json::accept(built.out)) << built.out;
  const ProcessResult made =
      run_voxdag({"scene", "sponge", "--size", "1", "--json", "-o", path("\xfe.ply")});
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(nlohmann::json::accept(made.out)) << made.out;
  const ProcessResult wrong =
      run_voxdag({"verify", path("in.vdag"), "--mesh", path("\xfe.ply"), "--json"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("cover"), std::string::npos) << wrong.err;
  EXPECT_TRUE(nlohmann::json::accept(wrong.out)) << wrong.out;
}

TEST_F(Files, AWarningIsOneLineAndNoFailure) {
  std::filesystem::create_directory(path("new\nline"));
  write_text(path("new\nline/w.obj"),
             "mtllib none\x1b[31m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const ProcessResult warned =
      run_voxdag({"build", path("new\nline/w.obj"), "-r", "16", "-q", "-o", path("warned.esvo")});
  EXPECT_EQ(warned.status, 0);
  EXPECT_EQ(warned.err.find('\x1b'), std::string::npos);
  std::istringstream lines(warned.err);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.starts_with("voxdag: warning: ")) << line;
  EXPECT_EQ(shell("$V build $'new\\nline/w.obj' -r 16 -q -o closed.esvo 2>&-").status, 0);
  EXPECT_EQ(shell("$V build $'new\\nline/w.obj' -r 16 -q -o full.esvo 2>/dev/full").status, 0);
  EXPECT_EQ(read_text(path("closed.esvo")), read_text(path("warned.esvo")));
}

TEST_F(Files, NamesThatAreTooLongAreFoundBeforeTheWork) {
  for (const std::size_t length : {300, 30'000}) {
    const std::string name(length, 'a');
    expect_failure(run_voxdag({"render", path("in.vdag"), "-o", path(name + ".png")}), 1,
                   ".png: cannot write: File name too long");
  }
}

TEST_F(Files, AMappedFileThatIsCutShortIsAnError) {
  // A binary STL of six million triangles, all zeros: reading takes so long that the file can be
  // truncated meanwhile.
  constexpr std::uint32_t kTriangles = 6'000'000;
  std::string header(84, '\0');
  std::memcpy(header.data() + 80, &kTriangles, sizeof kTriangles);
  write_text(path("cut.stl"), header);
  std::filesystem::resize_file(path("cut.stl"), 84 + std::uint64_t{50} * kTriangles);
  Process reading(voxdag_command({"build", path("cut.stl"), "-r", "64", "-o", path("cut.vdag")}));
  reading.wait_until_it_maps(path("cut.stl"));
  write_text(path("cut.stl"), "");
  expect_failure(reading.wait(), 1, "truncated");
  EXPECT_EQ(files_like("cut.vdag"), 0);
}

}  // namespace
}  // namespace voxdag::cli
