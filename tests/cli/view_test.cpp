#include <gtest/gtest.h>

#include <chrono>
#include <csignal>

#include "process.hpp"
#include "support/temp_dir.hpp"
#include "viewer/http_client.hpp"

namespace voxdag {
namespace {

class View : public testing::Test {
 protected:
  View() {
    const std::string mesh = dir_ / "mesh.ply";
    EXPECT_EQ(run_voxdag({"scene", "city", "--size", "1", "-o", mesh, "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"build", mesh, "-r", "256", "-o", plain_, "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"convert", plain_, "--compact", "-o", small_, "--quiet"}).status, 0);
  }

  /// Returns the port of the address that the program prints, or 0.
  static int port_of(const Process& program) {
    const std::string url = program.wait_for_line(), start = "http://127.0.0.1:";
    EXPECT_TRUE(url.starts_with(start) && url.ends_with("/")) << url;
    return url.size() > start.size() ? std::atoi(url.c_str() + start.size()) : 0;
  }

  TempDir dir_;
  std::string plain_ = dir_ / "plain.vdag", small_ = dir_ / "small.vdag";
};

TEST_F(View, ServesTheSceneInThePlainForm) {
  for (const std::string& file : {plain_, small_}) {
    Process program(voxdag_command({"view", file, "--no-open"}));
    const int port = port_of(program);
    ASSERT_NE(port, 0);
    EXPECT_EQ(get(port, "/scene.vdag").body, read_text(plain_));
    EXPECT_EQ(get(port, "/").status, 200);
    program.send_signal(SIGTERM);
    const ProcessResult result = program.wait();
    EXPECT_EQ(result.status, 128 + SIGTERM);
    EXPECT_EQ(result.err.find("is compact") != std::string::npos, file == small_) << result.err;
    EXPECT_TRUE(result.err.ends_with(file + ": cancelled\n")) << result.err;
  }
}

TEST_F(View, ASignalEndsItWhileAClientIsConnected) {
  Process program(voxdag_command({"view", plain_, "--no-open", "-q"}));
  HttpClient client(port_of(program));
  client.send("GET / HT");
  const auto start = std::chrono::steady_clock::now();
  program.send_signal(SIGINT);
  EXPECT_EQ(program.wait().status, 128 + SIGINT);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(View, AFileItCannotShowIsRefusedBeforeItListens) {
  const std::string broken = dir_ / "broken.vdag", mesh = dir_ / "mesh.ply",
                    esvo = dir_ / "scene.esvo";
  std::string bytes = read_text(plain_);
  bytes[bytes.size() / 2] ^= 1;
  write_text(broken, bytes);
  ASSERT_EQ(run_voxdag({"build", mesh, "-r", "64", "-o", esvo, "--quiet"}).status, 0);
  expect_failure(run_voxdag({"view", broken}), 1, broken + ": chunk ");
  expect_failure(run_voxdag({"view", dir_ / "none.vdag"}), 1, "cannot open");
  expect_failure(run_voxdag({"view", mesh}), 1, "not a .vdag file");
  expect_failure(run_voxdag({"view", esvo}), 1, "is an ESVO, which the viewer cannot show");
}

TEST_F(View, AnAddressItCannotUseIsAnError) {
  expect_failure(run_voxdag({"view", plain_, "--listen", "192.0.2.1"}), 1,
                 "cannot listen on 192.0.2.1");
  expect_failure(run_voxdag({"view", plain_, "--port", "70000"}), 2, "--port");
}

}  // namespace
}  // namespace voxdag
