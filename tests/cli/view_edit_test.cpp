/// `voxdag view --edit`: what the program does, beside the server that tests/viewer tests.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "city_dag.hpp"
#include "viewer/edit_page.hpp"
#include "voxdag/file/vdag_file.hpp"

namespace voxdag::cli {
namespace {

class ViewEdit : public CityDag {
 protected:
  /// A running program, and the page that edits with it.
  struct Editor {
    explicit Editor(const std::string& file, std::vector<std::string> options = {})
        : program(voxdag_command(command(file, std::move(options)))) {
      const std::string url = program.wait_for_line(), start = "http://127.0.0.1:";
      EXPECT_TRUE(url.starts_with(start)) << url;
      port = std::atoi(url.c_str() + start.size());
      token = url.substr(url.find("/?edit=") + 7);
      const std::string open = ask("open");
      std::memcpy(&writer, open.data(), std::min(open.size(), sizeof writer));
    }
    static std::vector<std::string> command(const std::string& file,
                                            std::vector<std::string> options) {
      options.insert(options.begin(), {"view", "--edit", file, "--no-open"});
      return options;
    }
    /// Returns the body of the answer.
    std::string ask(const std::string& path, const std::string& body = {}) const {
      return voxdag::ask(port, edit_request(port, path, token, writer, body)).body;
    }

    Process program;
    int port = 0;
    std::uint32_t writer = 0;
    std::string token;
  };
};

TEST_F(ViewEdit, SavesBesideTheFileAndTellsOfEditsThatAreLost) {
  for (const std::string& file : {plain_, small_}) {
    Editor editor(file);
    EXPECT_EQ(editor.ask("file"), std::filesystem::path(file).stem().string() + "-edited.vdag\n");
    editor.ask("stroke", "remove,ball,0,0,0,1000");
    EXPECT_EQ(editor.ask("save", "empty"), "empty.vdag\n");
    EXPECT_EQ(editor.ask("save", "empty"), "empty.vdag exists\n");
    editor.ask("undo");
    EXPECT_EQ(editor.ask("save?replace", "empty"), "empty.vdag\n");
    EXPECT_EQ(run_voxdag({"verify", dir_ / "empty.vdag"}).status, 0);
    if (file == plain_) {
      EXPECT_EQ(VdagFile(dir_ / "empty.vdag").view().node_words(),
                VdagFile(plain_).view().node_words());
    }
    editor.ask("redo");
    editor.program.send_signal(SIGINT);
    const ProcessResult result = editor.program.wait();
    EXPECT_EQ(result.status, 128 + SIGINT);
    EXPECT_NE(result.err.find("the last edits were not saved"), std::string::npos) << result.err;
    std::filesystem::remove(dir_ / "empty.vdag");
  }
}

TEST_F(ViewEdit, AKilledServerLeavesTheOldFileOrTheNewOne) {
  const std::string saved = dir_ / "saved.vdag";
  std::filesystem::copy_file(plain_, saved);
  const std::string before = read_text(saved), stroke = "remove,ball,0,0,0,3";
  std::string after;
  {
    const Editor editor(plain_);
    editor.ask("stroke", stroke);
    EXPECT_EQ(editor.ask("save", "new"), "new.vdag\n");
    after = read_text(dir_ / "new.vdag");
  }
  for (const int milliseconds : {0, 1, 2, 4, 8, 16}) {
    Editor editor(plain_);
    editor.ask("stroke", stroke);
    HttpClient client(editor.port);
    client.send(edit_request(editor.port, "save?replace", editor.token, editor.writer, "saved"));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    editor.program.send_signal(SIGKILL);
    editor.program.wait();
    const std::string left = read_text(saved);
    EXPECT_TRUE(left == before || left == after) << milliseconds << " ms";
  }
}

TEST_F(ViewEdit, OtherMachinesAndOtherFoldersAreRefused) {
  expect_failure(run_voxdag({"view", "--edit", plain_, "--no-open", "--listen", "0.0.0.0"}), 1,
                 "cannot edit on 0.0.0.0");
  expect_failure(run_voxdag({"view", plain_, "--no-open", "-o", "a.vdag"}), 2, "--edit");
  Editor editor(plain_, {"-o", dir_ / "other name.vdag"});
  EXPECT_EQ(editor.ask("file"), "other name.vdag\n");
  EXPECT_NE(editor.ask("save", "../a").find("no name of a file"), std::string::npos);
}

}  // namespace
}  // namespace voxdag::cli
