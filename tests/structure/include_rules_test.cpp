#include "include_rules.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace voxdag {
namespace {

namespace fs = std::filesystem;

const fs::path kSourceDir = VOXDAG_SOURCE_DIR;
const fs::path kTable = kSourceDir / "tests/structure/include_rules.txt";

/// A tree of source files that vanishes with the test.
class TemporaryTree {
 public:
  TemporaryTree() : root_(fs::temp_directory_path() / ("voxdag-" + std::to_string(getpid()))) {
    fs::create_directories(root_);
  }
  ~TemporaryTree() { fs::remove_all(root_); }
  const fs::path& root() const { return root_; }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }

 private:
  fs::path root_;
};

TEST(IncludeRules, EverySourceIncludesOnlyWhatItsFolderMay) {
  const auto broken = broken_includes(kSourceDir / "src/voxdag", read_include_rules(kTable));
  for (const std::string& line : broken) ADD_FAILURE() << line;
}

TEST(IncludeRules, RulesAreTransitive) {
  const IncludeRules rules = read_include_rules(kTable);
  EXPECT_TRUE(rules.at("dag").count("image"));
  EXPECT_TRUE(rules.at("cpu").count("layout"));
}

TEST(IncludeRules, AViewerNeedsNoBuilder) {
  const IncludeRules rules = read_include_rules(kTable);
  for (const char* viewer : {"trace", "render", "file"})
    for (const char* builder : {"mesh", "voxelize", "dag", "esvo"})
      EXPECT_FALSE(rules.at(viewer).count(builder)) << viewer << " may include " << builder;
}

TEST(IncludeRules, AForbiddenIncludeIsFoundWithItsLine) {
  const TemporaryTree tree;
  tree.write("mesh/mesh.hpp", "#include \"voxdag/mesh/other.hpp\"\n");
  tree.write("mesh/other.hpp", "#include <vector>\n");
  tree.write("trace/cast.hpp", "#pragma once\n  #  include \"voxdag/mesh/mesh.hpp\"\n");
  const auto broken = broken_includes(tree.root(), read_include_rules(kTable));
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0], "trace/cast.hpp:2: includes voxdag/mesh/mesh.hpp");
}

TEST(IncludeRules, AFolderWithoutARuleIsFound) {
  const TemporaryTree tree;
  tree.write("misc/odd.cpp", "");
  EXPECT_EQ(broken_includes(tree.root(), read_include_rules(kTable)).size(), 1u);
}

}  // namespace
}  // namespace voxdag
