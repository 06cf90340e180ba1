#include "lab/report/document.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::lab {
namespace {

Document document_with(DocumentPart part) { return {"Title", {{"Section", 1, {std::move(part)}}}}; }

TEST(Document, MarkdownHasHeadingsByDepth) {
  const Document document{"A", {{"B", 1, {Paragraph{"text"}}}, {"C", 2, {}}}};
  EXPECT_EQ(markdown_of(document), "# A\n\n## B\n\ntext\n\n### C\n\n");
}

TEST(Document, MarkdownTablesAlignNumbersToTheRight) {
  const Table table{"Sizes", {"scene", "MB"}, {{"a|b", "1.5"}}};
  EXPECT_EQ(
      markdown_of(document_with(table)),
      "# Title\n\n## Section\n\n**Sizes**\n\n| scene | MB |\n|---|---:|\n| a\\|b | 1.5 |\n\n");
}

TEST(Document, ATableWithoutRowsSaysSo) {
  const Document document = document_with(Table{"Sizes", {"scene", "MB"}, {}});
  EXPECT_EQ(markdown_of(document), "# Title\n\n## Section\n\nSizes: nothing was measured.\n\n");
  EXPECT_NE(html_of(document, ".").find("<p>Sizes: nothing was measured.</p>"), std::string::npos);
}

TEST(Document, HtmlEscapesText) {
  const std::string html = html_of(document_with(Paragraph{"a < b & \"c\""}), ".");
  EXPECT_NE(html.find("<p>a &lt; b &amp; &quot;c&quot;</p>"), std::string::npos);
}

TEST(Document, WordsInBackquotesAreCode) {
  const Document document = document_with(Paragraph{"Run `build` and `a < b`."});
  EXPECT_NE(html_of(document, ".").find("Run <code>build</code> and <code>a &lt; b</code>."),
            std::string::npos);
  EXPECT_NE(markdown_of(document).find("Run `build` and `a < b`."), std::string::npos);
}

TEST(Document, HtmlContainsItsPictures) {
  const TempDir dir;
  for (const auto& [bytes, base64] : {std::pair("M", "TQ=="), {"Ma", "TWE="}, {"Man", "TWFu"}}) {
    write_text(dir / "a.svg", bytes);
    const std::string html = html_of(document_with(Picture{"A chart.", "a.svg"}), dir.path());
    EXPECT_NE(html.find(std::string("src=\"data:image/svg+xml;base64,") + base64 + "\""),
              std::string::npos)
        << html;
    EXPECT_NE(html.find("<figcaption>A chart.</figcaption>"), std::string::npos);
  }
}

TEST(Document, PicturesSideBySideAreARow) {
  const TempDir dir;
  write_text(dir / "a.svg", "a");
  write_text(dir / "b.svg", "b");
  const Document document =
      document_with(PictureRow{{{"Cubes.", "a.svg"}, {"Contours.", "b.svg"}}});
  EXPECT_NE(markdown_of(document).find("| ![Cubes.](a.svg) | ![Contours.](b.svg) |\n| --- | --- |\n"
                                       "| Cubes. | Contours. |\n\n"),
            std::string::npos);
  const std::string html = html_of(document, dir.path());
  EXPECT_LT(html.find("<div class=\"row\">"), html.find("<figcaption>Cubes.</figcaption>"));
  EXPECT_NE(html.find("<figcaption>Contours.</figcaption>"), std::string::npos);
}

TEST(Document, AMissingPictureIsAnError) {
  const TempDir dir;
  const std::string error = error_of([&] {
    html_of(document_with(Picture{"", "none.png"}), dir.path());
  });
  EXPECT_TRUE(error.starts_with((dir / "none.png").string())) << error;
}

}  // namespace
}  // namespace voxdag::lab
