#pragma once
/// A report of text, tables and pictures, as Markdown and as one HTML page that needs no other
/// file.
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace voxdag::lab {

struct Paragraph {
  std::string text;  ///< Words in `backquotes` are code.
};

/// The command that made what stands above it.
struct CommandLine {
  std::string text;
};

/// A table without rows says that nothing was measured.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< Each has as many cells as the header.
  std::size_t text_columns = 1;  ///< So many columns from the left hold text, the others numbers.
};

/// A PNG, JPEG or SVG.
struct Picture {
  std::string caption;
  std::filesystem::path file;  ///< Relative to the folder of the report.
};

/// Pictures of equal size side by side, for comparison.
struct PictureRow {
  std::vector<Picture> pictures;
};

using DocumentPart = std::variant<Paragraph, CommandLine, Table, Picture, PictureRow>;

struct Section {
  std::string title;
  int depth = 1;  ///< 1: a chapter; 2: a section of it.
  std::vector<DocumentPart> parts;
};

struct Document {
  std::string title;
  std::vector<Section> sections;
};

/// Returns Markdown. Its pictures are links to the files.
std::string markdown_of(const Document& document);

/// Returns an HTML page that contains its pictures, which are read from `folder`. Throws Error if
/// one cannot be read or is of another kind.
std::string html_of(const Document& document, const std::filesystem::path& folder);

}  // namespace voxdag::lab
