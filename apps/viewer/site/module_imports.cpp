#include "viewer/site/module_imports.hpp"

#include <cctype>
#include <filesystem>

namespace voxdag {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}

/// Removes `word` and the spaces behind it from the end of the text. Returns false, and changes
/// nothing, if the text does not end so.
bool take_word(std::string_view& text, std::string_view word) {
  std::string_view rest = text;
  while (!rest.empty() && std::isspace(static_cast<unsigned char>(rest.back())) != 0)
    rest.remove_suffix(1);
  if (!rest.ends_with(word)) return false;
  rest.remove_suffix(word.size());
  if (!rest.empty() && is_word(word.front()) && (is_word(rest.back()) || rest.back() == '.'))
    return false;
  text = rest;
  return true;
}

}  // namespace

std::vector<ModuleImport> module_imports(std::string_view path, std::string_view source) {
  namespace fs = std::filesystem;
  std::vector<ModuleImport> imports;
  for (std::size_t quote = source.find_first_of("'\""); quote != source.npos;
       quote = source.find_first_of("'\"", quote + 1)) {
    const std::string_view rest = source.substr(quote + 1);
    if (!rest.starts_with("./") && !rest.starts_with("../")) continue;
    std::string_view before = source.substr(0, quote);
    // Comments name types by import('...'), without `await`.
    const bool is_awaited = take_word(before, "(");
    if (is_awaited ? !take_word(before, "import") || !take_word(before, "await")
                   : !take_word(before, "from") && !take_word(before, "import"))
      continue;
    const std::size_t end = source.find(source[quote], quote + 1);
    if (end == source.npos) break;
    const std::string_view specifier = source.substr(quote + 1, end - quote - 1);
    imports.push_back(
        {quote + 1, end,
         (fs::path(path).parent_path() / specifier).lexically_normal().generic_string(),
         is_awaited});
    quote = end;
  }
  return imports;
}

std::string with_bare_imports(std::string_view path, std::string_view source) {
  std::string text;
  std::size_t at = 0;
  for (const ModuleImport& import : module_imports(path, source)) {
    text.append(source.substr(at, import.begin - at)).append("voxdag/").append(import.path);
    at = import.end;
  }
  return text.append(source.substr(at));
}

}  // namespace voxdag
