/// Writes the C++ source that defines page_files(), and a copy of the page with its constants:
///
///   embed OUT.cpp OUT_FOLDER PAGE_FOLDER CONSTANTS.js FILE...
///
/// FILE... are the files of the page: paths from PAGE_FOLDER, or PATH=SOURCE for files that lie
/// elsewhere. With build/voxdag.js, index.html says that the page has the program. The build runs
/// it.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Embedded {
  std::string path, type, bytes;
};

std::string content_type(const fs::path& file) {
  constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".glsl", "text/plain; charset=utf-8"},
      {".json", "application/json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".woff2", "font/woff2"},
      {".gz", "application/gzip"}};
  for (const auto& [extension, type] : kTypes)
    if (file.extension() == extension) return std::string(type);
  throw std::runtime_error(file.string() + ": no content type is known for this extension");
}

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns a shader without its comments, which are a fifth of its compressed size. Lines keep
/// their numbers. Throws for a comment that begins with "/*".
std::string without_comments(const std::string& shader) {
  if (shader.find("/*") != std::string::npos)
    throw std::runtime_error("a shader has \"/*\": only comments that begin with // are removed");
  std::string text;
  for (std::size_t at = 0; at < shader.size();) {
    const std::size_t end = std::min(shader.find('\n', at), shader.size());
    const std::string_view line = std::string_view(shader).substr(at, end - at);
    const std::string_view code = line.substr(0, line.find("//"));
    text += code.substr(0, code.find_last_not_of(' ') + 1);
    text += '\n';
    at = end + 1;
  }
  return text;
}

/// Writes the file unless it has these bytes already: a file that did not change is not compiled
/// again.
void write(const fs::path& file, const std::string& bytes) {
  if (fs::exists(file) && read(file) == bytes) return;
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// Throws for text that would end the element in which a single-file page holds it.
void check_can_be_inlined(const Embedded& file) {
  if (file.path.ends_with(".html") || file.type.find("text/") != 0) return;
  std::string lower = file.bytes;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view end : {"</script", "</style", "<!--"})
    if (lower.find(end) != std::string::npos)
      throw std::runtime_error(file.path + ": has \"" + std::string(end) +
                               "\", which a page in a single file cannot hold: escape the \"<\"");
}

/// Returns the bytes as C++ string literals.
std::string literal(const std::string& bytes) {
  std::string text = "\"";
  std::size_t column = 0;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || c == '?') {
      text += '\\';
      text += c;
    } else if (byte >= 0x20 && byte < 0x7F) {
      text += c;
    } else {
      char octal[5];
      std::snprintf(octal, sizeof octal, "\\%03o", static_cast<unsigned>(byte));
      text += octal;
    }
    if (++column % 100 == 0) text += "\"\n    \"";
  }
  return text + "\"";
}

/// Says in index.html that the page has the program that builds: build/program.js reads it.
void announce_program(std::vector<Embedded>& files) {
  constexpr std::string_view kMain = "<main id=\"container\"";
  for (Embedded& file : files) {
    if (file.path != "index.html") continue;
    const std::size_t at = file.bytes.find(kMain);
    if (at == std::string::npos)
      throw std::runtime_error("index.html: lacks " + std::string(kMain));
    file.bytes.insert(at + kMain.size(), " data-program");
  }
}

std::string source_of(const std::vector<Embedded>& files) {
  std::string text =
      "// Made by apps/viewer/generate/embed.cpp. Do not edit.\n"
      "#include \"viewer/embedded/page_files.hpp\"\n\nnamespace voxdag {\nnamespace {\n\n";
  for (std::size_t i = 0; i < files.size(); ++i)
    text +=
        "constexpr char kFile" + std::to_string(i) + "[] =\n    " + literal(files[i].bytes) + ";\n";
  text += "\nconstexpr PageFile kFiles[] = {\n";
  for (std::size_t i = 0; i < files.size(); ++i)
    text += "    {\"" + files[i].path + "\", \"" + files[i].type + "\", {kFile" +
            std::to_string(i) + ", sizeof kFile" + std::to_string(i) + " - 1}},\n";
  return text +
         "};\n\n}  // namespace\n\nstd::span<const PageFile> page_files() { return kFiles; }\n\n"
         "}  // namespace voxdag\n";
}

void embed(int argc, char** argv) {
  if (argc < 6)
    throw std::runtime_error("usage: embed OUT.cpp OUT_FOLDER PAGE_FOLDER CONSTANTS.js FILE...");
  const fs::path source = argv[1], copy = argv[2], page = argv[3];
  std::vector<Embedded> files = {{"constants.js", content_type("constants.js"), read(argv[4])}};
  bool has_program = false;
  for (int i = 5; i < argc; ++i) {
    const std::string argument = argv[i], path = argument.substr(0, argument.find('='));
    const fs::path from =
        path == argument ? page / path : fs::path(argument.substr(path.size() + 1));
    const std::string bytes = read(from);
    files.push_back(
        {path, content_type(path), path.ends_with(".glsl") ? without_comments(bytes) : bytes});
    has_program |= path == "build/voxdag.js";
  }
  if (has_program) announce_program(files);
  std::sort(files.begin(), files.end(),
            [](const Embedded& a, const Embedded& b) { return a.path < b.path; });
  for (const Embedded& file : files) {
    check_can_be_inlined(file);
    write(copy / file.path, file.bytes);
  }
  // Removes copies of files that the page no longer has.
  std::vector<fs::path> stale;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(copy)) {
    const std::string path = entry.path().lexically_relative(copy).generic_string();
    const bool is_known = std::any_of(files.begin(), files.end(),
                                      [&](const Embedded& file) { return file.path == path; });
    if (entry.is_regular_file() && !is_known) stale.push_back(entry.path());
  }
  for (const fs::path& file : stale) fs::remove(file);
  write(source, source_of(files));
}

}  // namespace

int main(int argc, char** argv) try {
  embed(argc, argv);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "embed: %s\n", error.what());
  return 1;
}
