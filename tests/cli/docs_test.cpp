/// What the documentation shows is what the program takes.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = VOXDAG_SOURCE_DIR;
const fs::path kDocuments[] = {kSource / "README.md", kSource / "docs/cli.md"};

/// The blocks of a Markdown text that are fenced as ```LANGUAGE.
std::vector<std::string> fenced_blocks(const std::string& text, const std::string& language) {
  std::vector<std::string> blocks;
  std::istringstream lines(text);
  bool inside = false, wanted = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      wanted = inside && line.substr(3) == language;
      if (wanted) blocks.emplace_back();
    } else if (wanted) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

/// The words of every line "voxdag COMMAND ..." up to a comment or a pipe.
std::vector<std::vector<std::string>> documented_commands(const std::string& text) {
  std::vector<std::vector<std::string>> commands;
  for (const std::string& block : fenced_blocks(text, "")) {
    std::istringstream lines(block);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line.substr(0, line.find_first_of("#|>")));
      std::vector<std::string> command;
      for (std::string word; words >> word;) command.push_back(word);
      if (command.size() > 1 && command[0] == "voxdag") commands.push_back(command);
    }
  }
  return commands;
}

TEST(Docs, EveryCommandShownHasTheOptionsShown) {
  std::set<std::string> seen;
  for (const fs::path& document : kDocuments)
    for (const std::vector<std::string>& command : documented_commands(read_text(document))) {
      seen.insert(command[1]);
      // `voxdag bench build` has its options one command further down.
      const bool nested = command[1] == "bench";
      const std::string help =
          run_voxdag(nested ? std::vector{command[1], command[2], std::string("--help")}
                            : std::vector{command[1], std::string("--help")})
              .out;
      for (const std::string& word : command) {
        if (!word.starts_with('-')) continue;
        const std::regex option("(^|[ ,])" + word + "[ ,\n]");
        EXPECT_TRUE(std::regex_search(help, option))
            << document << ": " << command[1] << " " << word;
      }
    }
  EXPECT_GE(seen.size(), 7u);
}

TEST(Docs, TheReadmeShowsTheExampleThatIsTested) {
  const auto blocks = fenced_blocks(read_text(kSource / "README.md"), "cpp");
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0], read_text(kSource / "examples/build_and_cast.cpp"));
}

TEST(Docs, TheExampleIsUnderFortyLines) {
  const std::string text = read_text(kSource / "examples/build_and_cast.cpp");
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 40);
}

TEST(Docs, EveryFileLinkedToIsThere) {
  const std::regex link(R"(\]\(([^):#]+)\))");
  for (const fs::path& document : kDocuments) {
    const std::string text = read_text(document);
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it)
      EXPECT_TRUE(fs::exists(document.parent_path() / (*it)[1].str())) << (*it)[1];
  }
}

}  // namespace
}  // namespace voxdag
