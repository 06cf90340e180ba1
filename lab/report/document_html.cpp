/// Writes a document as one HTML page.
#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "lab/report/document.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"

namespace voxdag::lab {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #1a1a1a; }
h1, h2, h3 { line-height: 1.2; }
h2 { margin-top: 3rem; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.875rem; }
.scroll { overflow-x: auto; margin: 1rem 0; }
caption { text-align: left; font-weight: 600; padding-bottom: 0.4rem; }
th, td { padding: 0.2rem 0.6rem; text-align: right; border-bottom: 1px solid #e3e3e3; white-space: nowrap; }
th { border-bottom: 2px solid #888; vertical-align: bottom; }
.text { text-align: left; white-space: normal; }
figure { margin: 1.5rem 0; }
figure img { max-width: 100%; height: auto; }
.row { display: flex; gap: 0.75rem; }
.row figure { margin: 0.5rem 0; }
figcaption { color: #444; font-size: 0.9rem; }
pre { background: #f4f4f4; padding: 0.6rem 0.8rem; overflow-x: auto; font-size: 0.8125rem; }
)";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  return safe;
}

/// Returns the text with `words` in backquotes set as code.
std::string with_code(const std::string& text) {
  std::string html;
  bool is_code = false;
  for (const char c : text)
    if (c != '`')
      html += c;
    else
      html += std::exchange(is_code, !is_code) ? "</code>" : "<code>";
  return html;
}

std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < count; ++k)
      group |= std::to_integer<std::uint32_t>(bytes[i + k]) << (16 - 8 * k);
    for (std::size_t digit = 0; digit < 4; ++digit)
      text += digit <= count ? kDigits[group >> (18 - 6 * digit) & 63] : '=';
  }
  return text;
}

std::string media_type(const std::filesystem::path& file) {
  const std::string extension = file.extension();
  if (extension == ".svg") return "image/svg+xml";
  if (extension == ".png") return "image/png";
  if (extension == ".jpg") return "image/jpeg";
  throw Error(file, "", "is neither .svg, .png nor .jpg");
}

std::string row_of(const std::vector<std::string>& cells, const char* tag,
                   std::size_t text_columns) {
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i)
    row += fmt::format("<{0}{1}>{2}</{0}>", tag, i < text_columns ? " class=\"text\"" : "",
                       escaped(cells[i]));
  return row + "</tr>\n";
}

class HtmlWriter {
 public:
  explicit HtmlWriter(const std::filesystem::path& folder) : folder_(folder) {}

  std::string text;

  void operator()(const Paragraph& paragraph) {
    text += fmt::format("<p>{}</p>\n", with_code(escaped(paragraph.text)));
  }
  void operator()(const CommandLine& command) {
    text += fmt::format("<pre>{}</pre>\n", escaped(command.text));
  }
  void operator()(const Table& table) {
    if (table.rows.empty()) {
      (*this)(Paragraph{table.caption + ": nothing was measured."});
      return;
    }
    text += fmt::format("<div class=\"scroll\"><table>\n<caption>{}</caption>\n<thead>{}</thead>\n",
                        escaped(table.caption), row_of(table.header, "th", table.text_columns));
    for (const std::vector<std::string>& row : table.rows)
      text += row_of(row, "td", table.text_columns);
    text += "</table></div>\n";
  }
  void operator()(const PictureRow& row) {
    text += "<div class=\"row\">\n";
    for (const Picture& picture : row.pictures) (*this)(picture);
    text += "</div>\n";
  }
  void operator()(const Picture& picture) {
    const MappedFile file(folder_ / picture.file);
    text += fmt::format(
        "<figure><img src=\"data:{};base64,{}\" "
        "alt=\"{}\">\n<figcaption>{}</figcaption></figure>\n",
        media_type(picture.file), base64(file.bytes()), escaped(picture.caption),
        escaped(picture.caption));
  }

 private:
  const std::filesystem::path& folder_;
};

}  // namespace

std::string html_of(const Document& document, const std::filesystem::path& folder) {
  HtmlWriter writer(folder);
  writer.text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title>\n<style>{1}</style></head>\n"
      "<body>\n<h1>{0}</h1>\n",
      escaped(document.title), kStyle);
  for (const Section& section : document.sections) {
    writer.text += fmt::format("<h{0}>{1}</h{0}>\n", section.depth + 1, escaped(section.title));
    for (const DocumentPart& part : section.parts) std::visit(writer, part);
  }
  return writer.text + "</body></html>\n";
}

}  // namespace voxdag::lab
