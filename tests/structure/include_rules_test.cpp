#include "include_rules.hpp"

#include <gtest/gtest.h>

#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

const fs::path kSourceDir = VOXDAG_SOURCE_DIR;
const fs::path kTable = kSourceDir / "tests/structure/include_rules.txt";

void write_source(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  write_text(file, text);
}

TEST(IncludeRules, EverySourceIncludesOnlyWhatItsFolderMay) {
  const auto broken = broken_includes(kSourceDir / "src/voxdag", read_include_rules(kTable));
  for (const std::string& line : broken) ADD_FAILURE() << line;
}

TEST(IncludeRules, RulesAreTransitive) {
  const IncludeRules rules = read_include_rules(kTable);
  EXPECT_TRUE(rules.at("esvo").count("image"));
  EXPECT_TRUE(rules.at("cpu").count("layout"));
}

TEST(IncludeRules, AViewerNeedsNoBuilder) {
  const IncludeRules rules = read_include_rules(kTable);
  for (const char* viewer : {"trace", "render", "file"})
    for (const char* builder : {"mesh", "readers", "voxelize", "dag", "esvo"})
      EXPECT_FALSE(rules.at(viewer).count(builder)) << viewer << " may include " << builder;
}

TEST(IncludeRules, TheDagBuilderNeedsNoFileFormats) {
  const IncludeRules rules = read_include_rules(kTable);
  for (const char* builder : {"voxelize", "dag"})
    for (const char* format : {"io", "image", "readers", "file"})
      EXPECT_FALSE(rules.at(builder).count(format)) << builder << " may include " << format;
}

TEST(IncludeRules, AForbiddenIncludeIsFoundWithItsLine) {
  const TempDir tree;
  write_source(tree / "mesh/mesh.hpp", "#include \"voxdag/mesh/other.hpp\"\n");
  write_source(tree / "mesh/other.hpp", "#include <vector>\n");
  write_source(tree / "trace/cast.hpp", "#pragma once\n  #  include \"voxdag/mesh/mesh.hpp\"\n");
  const auto broken = broken_includes(tree.path(), read_include_rules(kTable));
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0], "trace/cast.hpp:2: includes voxdag/mesh/mesh.hpp");
}

TEST(IncludeRules, AFolderWithoutARuleIsFound) {
  const TempDir tree;
  write_source(tree / "misc/odd.cpp", "");
  EXPECT_EQ(broken_includes(tree.path(), read_include_rules(kTable)).size(), 1u);
}

}  // namespace
}  // namespace voxdag
