/// Writes a document as Markdown.
#include <fmt/core.h>

#include "lab/report/document.hpp"

namespace voxdag::lab {
namespace {

/// Returns the text of a table cell: a bar would end it.
std::string cell_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

std::string row_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += fmt::format(" {} |", cell_text(cell));
  return line + "\n";
}

std::string image_of(const Picture& picture) {
  return fmt::format("![{}]({})", picture.caption, picture.file.generic_string());
}

class MarkdownWriter {
 public:
  std::string text;

  void operator()(const Paragraph& paragraph) { text += paragraph.text + "\n\n"; }
  void operator()(const CommandLine& command) {
    text += fmt::format("```\n{}\n```\n\n", command.text);
  }
  void operator()(const Table& table) {
    if (table.rows.empty()) {
      (*this)(Paragraph{table.caption + ": nothing was measured."});
      return;
    }
    text += fmt::format("**{}**\n\n", table.caption) + row_of(table.header) + "|";
    for (std::size_t i = 0; i < table.header.size(); ++i)
      text += i < table.text_columns ? "---|" : "---:|";
    text += "\n";
    for (const std::vector<std::string>& row : table.rows) text += row_of(row);
    text += "\n";
  }
  void operator()(const PictureRow& row) {
    std::vector<std::string> images, captions;
    for (const Picture& picture : row.pictures) {
      images.push_back(image_of(picture));
      captions.push_back(picture.caption);
    }
    text += row_of(images);
    text += row_of(std::vector<std::string>(images.size(), "---"));
    text += row_of(captions);
    text += "\n";
  }
  void operator()(const Picture& picture) {
    text += fmt::format("{}\n\n*{}*\n\n", image_of(picture), picture.caption);
  }
};

}  // namespace

std::string markdown_of(const Document& document) {
  MarkdownWriter writer;
  writer.text = fmt::format("# {}\n\n", document.title);
  for (const Section& section : document.sections) {
    writer.text += fmt::format("{:#<{}} {}\n\n", "", section.depth + 1, section.title);
    for (const DocumentPart& part : section.parts) std::visit(writer, part);
  }
  return writer.text;
}

}  // namespace voxdag::lab
