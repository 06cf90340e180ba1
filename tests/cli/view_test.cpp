#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "city_dag.hpp"
#include "viewer/http_client.hpp"

namespace voxdag::cli {
namespace {

class View : public CityDag {
 protected:
  /// Returns the port of the address that the program prints, or 0.
  static int port_of(const Process& program) {
    const std::string url = program.wait_for_line(), start = "http://127.0.0.1:";
    EXPECT_TRUE(url.starts_with(start) && url.ends_with("/")) << url;
    return url.size() > start.size() ? std::atoi(url.c_str() + start.size()) : 0;
  }
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

TEST_F(View, ServesTheDagOfAMesh) {
  Process program(voxdag_command({"view", mesh_, "-r", "256", "--no-open"}));
  const int port = port_of(program);
  ASSERT_NE(port, 0);
  EXPECT_EQ(get(port, "/scene.vdag").body, read_text(plain_));
  program.send_signal(SIGTERM);
  EXPECT_EQ(program.wait().status, 128 + SIGTERM);
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

/// Waits until the file has a line, for 10 seconds at most. Returns its text.
std::string line_in(const std::string& file) {
  for (int i = 0; i < 400 && !read_text(file).ends_with("\n"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  return read_text(file);
}

TEST_F(View, OpensThePageWhereThereIsADisplay) {
  const std::string script = dir_ / "xdg-open", opened = dir_ / "opened.txt";
  // A browser that outlives the server.
  write_text(script, "#!/bin/sh\necho \"$1\" > '" + opened + "'\nexec sleep 3\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const auto command = [&](const std::string& display, std::vector<std::string> options) {
    std::vector<std::string> words = {"env", "PATH=" + dir_.path().string() + ":/usr/bin:/bin",
                                      "WAYLAND_DISPLAY=", "DISPLAY=" + display};
    options.insert(options.begin(), {"view", plain_, "-q"});
    for (const std::string& word : voxdag_command(options)) words.push_back(word);
    return words;
  };
  int port = 0;
  {
    Process program(command(":7", {}));
    port = port_of(program);
    EXPECT_EQ(line_in(opened), "http://127.0.0.1:" + std::to_string(port) + "/\n");
    program.send_signal(SIGTERM);
    EXPECT_EQ(program.wait().status, 128 + SIGTERM);
  }
  // The browser has none of the server's sockets: the port is free again.
  std::filesystem::remove(opened);
  Process again(command(":7", {"--no-open", "--port", std::to_string(port)}));
  EXPECT_EQ(port_of(again), port);
  Process headless(command("", {}));
  EXPECT_NE(port_of(headless), 0);
  EXPECT_EQ(get(port, "/").status, 200);
  EXPECT_FALSE(std::filesystem::exists(opened));
}

TEST_F(View, AFileItCannotShowIsRefusedBeforeItListens) {
  const std::string broken = dir_ / "broken.vdag", esvo = dir_ / "scene.esvo";
  std::string bytes = read_text(plain_);
  bytes[bytes.size() / 2] ^= 1;
  write_text(broken, bytes);
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "64", "-o", esvo, "--quiet"}).status, 0);
  expect_failure(run_voxdag({"view", broken}), 1, broken + ": chunk ");
  expect_failure(run_voxdag({"view", dir_ / "none.vdag"}), 1, "cannot open");
  write_text(dir_ / "text", "no scene");
  expect_failure(run_voxdag({"view", dir_ / "text"}), 1, "not a .vdag file");
  expect_failure(run_voxdag({"view", esvo}), 1, "is an ESVO, which the viewer cannot show");
}

TEST_F(View, AnAddressItCannotUseIsAnError) {
  expect_failure(run_voxdag({"view", plain_, "--listen", "192.0.2.1"}), 1,
                 "cannot listen on 192.0.2.1");
  expect_failure(run_voxdag({"view", plain_, "--port", "70000"}), 2, "--port");
}

}  // namespace
}  // namespace voxdag::cli
