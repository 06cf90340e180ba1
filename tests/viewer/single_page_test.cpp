#include "viewer/site/single_page.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/base64.hpp"

namespace voxdag {
namespace {

constexpr std::string_view kScript = "text/javascript; charset=utf-8";

std::string page_text(std::vector<PageFile> files) {
  const SinglePage page = make_single_page(files);
  return page.before + "SCENE" + page.after;
}

/// Returns a page with this <head> and these other files, beside "a.js".
std::vector<PageFile> page_with(std::string_view html, std::vector<PageFile> files = {}) {
  files.push_back({"index.html", "text/html; charset=utf-8", html});
  files.push_back({"a.js", kScript, "import './b/c.js';"});
  files.push_back({"b/c.js", kScript, "export {};"});
  return files;
}

constexpr std::string_view kHtml =
    "<html><head><meta charset=\"utf-8\"></head><body><p>text</p>"
    "<script type=\"module\" src=\"a.js\"></script></body></html>";

TEST(SinglePage, ModulesBecomeAnImportMap) {
  const std::string text = page_text(page_with(kHtml));
  EXPECT_NE(text.find("\"voxdag/a.js\": \"data:text/javascript;base64," +
                      base64("import 'voxdag/b/c.js';") + "\""),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("\"voxdag/b/c.js\": \"data:text/javascript;base64," + base64("export {};") +
                      "\"}}</script>\n<script type=\"text/plain\" id=\"scene\">SCENE</script>\n"
                      "<script type=\"module\">import 'voxdag/a.js';</script>\n</body></html>"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("src="), std::string::npos);
}

TEST(SinglePage, TheMapComesBeforeTheModule) {
  const std::string text = page_text(page_with(kHtml));
  EXPECT_LT(text.find("type=\"importmap\""), text.find("type=\"module\""));
}

TEST(SinglePage, OtherTextsBecomeElements) {
  const std::string text = page_text(
      page_with(kHtml, {{"gpu/cast.glsl", "text/plain", "a < b;"}, {"work.js", kScript, "go();"}}));
  EXPECT_NE(text.find("<script type=\"text/plain\" data-path=\"gpu/cast.glsl\">a < b;</script>"),
            std::string::npos);
  EXPECT_NE(text.find("<script type=\"text/plain\" data-path=\"work.js\">go();</script>"),
            std::string::npos);
  EXPECT_EQ(text.find("voxdag/work.js"), std::string::npos);
}

TEST(SinglePage, StylesAndPicturesMoveIn) {
  const std::string text =
      page_text(page_with("<head><link rel=\"stylesheet\" href=\"a.css\"><link rel=\"icon\" "
                          "type=\"image/svg+xml\" href=\"i.svg\"></head>"
                          "<script type=\"module\" src=\"a.js\"></script><img src=\"i.svg\">",
                          {{"a.css", "text/css; charset=utf-8", "p { top: 0 }"},
                           {"i.svg", "image/svg+xml", "<svg/>"}}));
  const std::string url = "data:image/svg+xml;base64," + base64("<svg/>");
  EXPECT_NE(text.find("<style>\np { top: 0 }</style>"), std::string::npos) << text;
  EXPECT_NE(text.find("<link rel=\"icon\" type=\"image/svg+xml\" href=\"" + url + "\">"),
            std::string::npos);
  EXPECT_NE(text.find("<img src=\"" + url + "\">"), std::string::npos);
}

TEST(SinglePage, TheSceneComesAfterTheRestOfThePage) {
  const std::string text = page_text(page_with(
      "<head><script type=\"module\" src=\"a.js\"></script></head><body><p>wait</p></body>"));
  EXPECT_LT(text.find("<p>wait</p>"), text.find("importmap"));
}

TEST(SinglePage, DataUrlsStay) {
  const std::string link = "<link rel=\"icon\" href=\"data:image/svg+xml,abc\">";
  const std::string html =
      "<head>" + link + "</head><script type=\"module\" src=\"a.js\"></script>";
  EXPECT_NE(page_text(page_with(html)).find(link), std::string::npos);
}

TEST(SinglePage, ItsPolicyForbidsConnections) {
  const std::string text = page_text(page_with(kHtml));
  EXPECT_NE(
      text.find("<head><meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" "
                "content=\"default-src 'none'; "),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("connect-src data: blob:;"), std::string::npos);
}

TEST(SinglePage, APageThatCannotBeOneFileIsRefused) {
  const auto error = [](std::vector<PageFile> files) {
    return error_of([&] { make_single_page(files); });
  };
  EXPECT_EQ(error({}), "index.html: refers to index.html, which the page lacks");
  EXPECT_EQ(error(page_with("<head></head>")), "index.html: has no module");
  EXPECT_EQ(error(page_with("<head></head><script type=\"module\" src=\"x.js\"></script>")),
            "x.js: refers to x.js, which the page lacks");
  EXPECT_EQ(error(page_with("<head></head><script src=\"a.js\"></script>")),
            "index.html: must have one script with src=, a module");
  EXPECT_EQ(error(page_with("<head><link rel=\"manifest\" href=\"b/c.js\"></head>")),
            "index.html: refers to b/c.js, which is no module, style or picture");
  EXPECT_EQ(error(page_with("<head></head><img src=\"https://example.com/a.png\">")),
            "index.html: refers to https://example.com/a.png, which the page lacks");
  EXPECT_EQ(error({{"index.html", "text/html", kHtml}, {"a.js", kScript, "import './no.js';"}}),
            "a.js: refers to no.js, which the page lacks");
  EXPECT_EQ(error({{"index.html", "text/html", kHtml}, {"a.js", kScript, "import '../no.js';"}}),
            "a.js: refers to ../no.js, which the page lacks");
}

TEST(Base64, TheExamplesOfTheRfc) {
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : examples) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

TEST(Base64, PiecesMakeTheTextOfTheWhole) {
  const std::string bytes = "any carnal pleasure";
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    Base64 encoder;
    std::string text = encoder.add(bytes.substr(0, cut));
    text += encoder.add(bytes.substr(cut));
    EXPECT_EQ(text + encoder.finish(), base64(bytes)) << cut;
  }
}

}  // namespace
}  // namespace voxdag
