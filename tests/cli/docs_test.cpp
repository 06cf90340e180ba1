/// Checks the documentation against the program and the files of the repository.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = VOXDAG_SOURCE_DIR;

/// Returns every Markdown page of the repository.
std::vector<fs::path> documents() {
  std::vector<fs::path> pages = {kSource / "README.md",
                                 kSource / "HACKING.md",
                                 kSource / "CHANGELOG.md",
                                 kSource / "lab/README.md",
                                 kSource / "lab/results/README.md",
                                 kSource / "lab/results/papers.md"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  return pages;
}

/// Returns the blocks of a Markdown text that are fenced as ```LANGUAGE.
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

/// Returns the words of every line "voxdag COMMAND ..." up to a comment or a pipe, in blocks
/// without language and in shell scripts.
std::vector<std::vector<std::string>> documented_commands(const std::string& text) {
  std::vector<std::vector<std::string>> commands;
  for (const char* language : {"", "sh"})
    for (const std::string& block : fenced_blocks(text, language)) {
      std::istringstream lines(block);
      for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line.substr(0, line.find_first_of("#|>$")));
        std::vector<std::string> command;
        for (std::string word; words >> word;) command.push_back(word);
        if (command.size() > 1 && command[0] == "voxdag") commands.push_back(command);
      }
    }
  return commands;
}

TEST(Docs, EveryCommandShownHasTheOptionsShown) {
  std::set<std::string> seen;
  std::map<std::string, std::string> helps;
  for (const fs::path& document : documents())
    for (const std::vector<std::string>& command : documented_commands(read_text(document))) {
      seen.insert(command[1]);
      // The options of `voxdag bench build` belong to its second word.
      const bool nested = command[1] == "bench";
      if (nested && !has_lab()) continue;
      std::string& help = helps[command[1] + (nested ? " " + command[2] : "")];
      if (help.empty())
        help = run_voxdag(nested ? std::vector{command[1], command[2], std::string("--help")}
                                 : std::vector{command[1], std::string("--help")})
                   .out;
      for (const std::string& word : command) {
        // "-o" and "--eye", but not "-20,3,1".
        if (word.size() < 2 || word[0] != '-' || std::isdigit(static_cast<unsigned char>(word[1])))
          continue;
        // The value of "--section-box=-1,..." is no part of the name.
        const std::string name = word.substr(0, word.find('='));
        const std::regex option("(^|[ ,])" + name + "[ ,\n]");
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

/// Returns the anchor that GitHub gives a heading: lower case, spaces as hyphens, no punctuation.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading)
    if (c == ' ')
      anchor += '-';
    else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
      anchor += static_cast<char>(std::tolower(c));
  return anchor;
}

std::set<std::string> anchors_of(const std::string& text) {
  std::set<std::string> anchors;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with('#')) anchors.insert(anchor_of(line.substr(line.find(' ') + 1)));
  return anchors;
}

TEST(Docs, EveryLinkLeadsToAFileAndItsHeading) {
  const std::regex link(R"(\]\(([^):#]*)(#([^)]+))?\))");
  for (const fs::path& document : documents()) {
    const std::string text = read_text(document);
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string file = (*it)[1], heading = (*it)[3];
      const fs::path target = file.empty() ? document : document.parent_path() / file;
      EXPECT_TRUE(fs::exists(target)) << document << ": " << file;
      const bool found = heading.empty() || anchors_of(read_text(target)).count(heading) != 0;
      EXPECT_TRUE(found) << document << ": " << file << "#" << heading;
    }
  }
}

TEST(Docs, TheIndexNamesEveryPage) {
  const std::string index = read_text(kSource / "docs/README.md");
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / "docs")) {
    const std::string name = entry.path().lexically_relative(kSource / "docs");
    // cli.md lists the pages of cli/.
    if (!name.ends_with(".md") || name == "README.md" || name.starts_with("cli/")) continue;
    EXPECT_NE(index.find("(" + name + ")"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace voxdag::cli
