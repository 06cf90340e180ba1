#include "viewer/embedded/baked_page.hpp"

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Returns the text for HTML, in an element or in quotation marks.
std::string html_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

/// Returns JSON that cannot end the element that holds it: "<" occurs in texts only.
std::string script_json(std::string_view json) {
  std::string escaped;
  for (const char c : json) c == '<' ? escaped += "\\u003c" : escaped += c;
  return escaped;
}

/// Replaces the one `mark` of the page.
void replace(std::string& html, std::string_view mark, const std::string& text) {
  const std::size_t at = html.find(mark);
  if (at == std::string::npos) throw Error("index.html", "", "lacks " + std::string(mark));
  html.replace(at, mark.size(), text);
}

}  // namespace

BakedPage::BakedPage(const PageView& view)
    : index_(find_page_file("index.html")->bytes),
      files_(page_files().begin(), page_files().end()) {
  constexpr std::string_view kPicture = "<div class=\"picture\" id=\"picture\">", kEnd = "</main>";
  if (!view.title.empty())
    replace(index_, "<title>voxdag</title>", "<title>" + html_text(view.title) + "</title>");
  if (!view.poster.empty())
    replace(index_, kPicture,
            std::string(kPicture) + "<img class=\"poster\" alt=\"\" src=\"" + view.poster + "\">");
  if (!view.settings.empty())
    replace(index_, kEnd,
            std::string(kEnd) + "\n<script type=\"application/json\" id=\"settings\">" +
                script_json(view.settings) + "</script>");
  if (!view.has_scene)
    replace(index_, kEnd,
            std::string(kEnd) + "\n<script type=\"text/plain\" id=\"scene\"></script>");
  if (!view.edits && !has_program(files_))
    std::erase_if(files_, [](const PageFile& file) { return file.path.starts_with("edit/"); });
  for (PageFile& file : files_)
    if (file.path == "index.html") file.bytes = index_;
}

}  // namespace voxdag
