#include "viewer/site/export_site.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "gunzip.hpp"
#include "scenes.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "viewer/embedded/page_files.hpp"
#include "viewer/site/single_page.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// A scene that fails when its second half is read.
class FailingScene final : public SceneBytes {
 public:
  std::uint64_t size() const override { return scene_.size(); }
  std::string tag() const override { return scene_.tag(); }
  bool is_unchanged() const override { return true; }
  bool read(std::uint64_t offset, std::span<std::byte> out) const override {
    return offset < size() / 2 && scene_.read(offset, out);
  }

 private:
  PatternScene scene_{10'000'000};
};

/// Decodes base64 and gzip without the code that encodes them.
std::string unpacked(const std::string& text) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count);
  }
  return gunzip(bytes);
}

std::string scene_text(const std::string& page) {
  const std::string start = "<script type=\"text/plain\" id=\"scene\">";
  const std::size_t begin = page.find(start) + start.size();
  return page.substr(begin, page.find('<', begin) - begin);
}

TEST(ExportSite, TheFolderHasThePageAndTheScene) {
  const TempDir dir;
  const PatternScene scene(3'000'000);
  for (const char* name : {"site", "site2/"}) {
    std::uint64_t bytes = export_site(dir / name, scene);
    EXPECT_EQ(read_text(dir / name / "scene.vdag"), scene.text(0, scene.size() - 1));
    bytes -= scene.size();
    for (const PageFile& file : page_files()) {
      std::string text(file.bytes);
      if (file.path == "index.html") add_policy(text, kPagePolicy);
      EXPECT_EQ(read_text(dir / name / file.path), text) << file.path;
      bytes -= text.size();
    }
    if (has_program(page_files())) bytes -= read_text(dir / name / kTemplateName).size();
    EXPECT_EQ(bytes, 0u);
  }
  EXPECT_EQ(dir.count(), 2);
}

TEST(ExportSite, AnOldPageIsReplaced) {
  const TempDir dir;
  fs::create_directory(dir / "site");
  export_site(dir / "site", PatternScene(1000));
  export_site(dir / "site", PatternScene(2000));
  EXPECT_EQ(fs::file_size(dir / "site/scene.vdag"), 2000u);
  EXPECT_EQ(dir.count(), 1);
}

TEST(ExportSite, AFolderWithOtherFilesIsLeftAlone) {
  const TempDir dir;
  for (const std::string other : {"notes.txt", "app/notes.txt", "index.html.bak"}) {
    fs::create_directories((dir / other).parent_path());
    write_text(dir / other, "mine");
    EXPECT_NE(error_of([&] {
                export_site(dir.path(), PatternScene(1000));
              }).find("which is no file of the page"),
              std::string::npos);
    EXPECT_EQ(read_text(dir / other), "mine");
    fs::remove_all(dir / other);
  }
  write_text(dir / "file", "mine");
  EXPECT_NE(error_of([&] { export_site(dir / "file", PatternScene(1000)); }).find("is no folder"),
            std::string::npos);
}

TEST(ExportSite, AFailureLeavesNothing) {
  const TempDir dir;
  EXPECT_NE(error_of([&] { export_site(dir / "site", FailingScene()); }), "no error");
  EXPECT_NE(error_of([&] { export_single_page(dir / "a.html", FailingScene()); }), "no error");
  EXPECT_NE(error_of([&] { export_site(dir / "no/site", PatternScene(1000)); }), "no error");
  EXPECT_EQ(dir.count(), 0);
  // An existing page stays as it was.
  export_site(dir / "site", PatternScene(1000));
  EXPECT_NE(error_of([&] { export_site(dir / "site", FailingScene()); }), "no error");
  EXPECT_EQ(fs::file_size(dir / "site/scene.vdag"), 1000u);
  EXPECT_EQ(dir.count(), 1);
}

TEST(ExportSite, ACancelledExportLeavesNothing) {
  const TempDir dir;
  Progress progress;
  progress.cancel();
  EXPECT_THROW(export_site(dir / "site", PatternScene(1000), &progress), Cancelled);
  EXPECT_THROW(export_single_page(dir / "a.html", PatternScene(1000), &progress), Cancelled);
  EXPECT_EQ(dir.count(), 0);
}

TEST(ExportSinglePage, HoldsTheScene) {
  const TempDir dir;
  for (const std::uint64_t size : {64, 1000, 5'000'000}) {
    const PatternScene scene(size);
    const std::uint64_t bytes = export_single_page(dir / "a.html", scene);
    const std::string page = read_text(dir / "a.html");
    EXPECT_EQ(page.size(), bytes);
    EXPECT_EQ(unpacked(scene_text(page)), scene.text(0, size - 1));
  }
}

TEST(ExportSinglePage, EqualScenesMakeEqualFiles) {
  const TempDir dir;
  export_single_page(dir / "a.html", PatternScene(100'000));
  export_single_page(dir / "b.html", PatternScene(100'000));
  EXPECT_EQ(read_text(dir / "a.html"), read_text(dir / "b.html"));
}

TEST(PageFiles, AreSortedAndComplete) {
  EXPECT_TRUE(std::is_sorted(page_files().begin(), page_files().end(),
                             [](const PageFile& a, const PageFile& b) { return a.path < b.path; }));
  for (const char* path : {"index.html", "app/app.js", "constants.js"})
    EXPECT_NE(find_page_file(path), nullptr) << path;
  for (const char* path : {"", "index", "zzz", "app"}) EXPECT_EQ(find_page_file(path), nullptr);
}

TEST(PageFiles, NoneEndsAnElementThatHoldsIt) {
  for (const PageFile& file : page_files()) {
    std::string lower(file.bytes);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (file.path == "index.html") continue;
    EXPECT_EQ(lower.find("</script"), std::string::npos) << file.path;
    EXPECT_EQ(lower.find("</style"), std::string::npos) << file.path;
  }
}

}  // namespace
}  // namespace voxdag
