#include "viewer/site/single_page.hpp"

#include <algorithm>
#include <set>

#include "viewer/embedded/baked_page.hpp"
#include "viewer/site/module_imports.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/base64.hpp"

namespace voxdag {
namespace {

/// Forbids all connections: the page holds all that it needs.
constexpr std::string_view kSinglePagePolicy =
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' data:; "
    "style-src 'unsafe-inline'; img-src data: blob:; font-src data:; worker-src blob:; "
    "connect-src data: blob:; base-uri 'none'; form-action 'none'";

/// Returns the file with this path, or null.
const PageFile* find_file(std::span<const PageFile> files, std::string_view path) {
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const PageFile& file) { return file.path == path; });
  return found == files.end() ? nullptr : &*found;
}

const PageFile& file_at(std::span<const PageFile> files, std::string_view path,
                        std::string_view user) {
  if (const PageFile* const file = find_file(files, path)) return *file;
  throw Error(std::string(user), "", "refers to " + std::string(path) + ", which the page lacks");
}

std::string data_url(const PageFile& file, std::string_view bytes) {
  const std::string_view type = file.type.substr(0, file.type.find(';'));
  return "data:" + std::string(type) + ";base64," + base64(bytes);
}

/// Returns the paths of a module and of all that it imports.
std::set<std::string> reachable_modules(std::span<const PageFile> files, const std::string& entry) {
  std::set<std::string> paths = {entry};
  std::vector<std::string> left = {entry};
  while (!left.empty()) {
    const std::string path = left.back();
    left.pop_back();
    for (const ModuleImport& import : module_imports(path, file_at(files, path, path).bytes)) {
      if (import.is_awaited && find_file(files, import.path) == nullptr) continue;
      file_at(files, import.path, path);
      if (paths.insert(import.path).second) left.push_back(import.path);
    }
  }
  return paths;
}

/// A start tag of the page.
struct Tag {
  std::size_t begin, end;  ///< In the text; `end` is behind its ">".
  std::string_view text;

  /// Returns the value of an attribute in double quotation marks; empty if it has none.
  std::string_view attribute(std::string_view name) const {
    const std::string start = std::string(" ").append(name).append("=\"");
    const std::size_t at = text.find(start);
    if (at == text.npos) return {};
    const std::size_t value = at + start.size();
    return text.substr(value, text.find('"', value) - value);
  }
};

/// Returns the first <script>, <link> or <img> that begins at `from` or later and refers to a file.
Tag next_reference(std::string_view html, std::size_t from) {
  for (std::size_t begin = html.find('<', from); begin != html.npos;
       begin = html.find('<', begin + 1)) {
    const std::string_view rest = html.substr(begin);
    if (rest.starts_with("<!--")) {
      begin = std::min(html.find("-->", begin), html.size() - 1);
      continue;
    }
    if (!rest.starts_with("<script ") && !rest.starts_with("<link ") && !rest.starts_with("<img "))
      continue;
    const Tag tag{begin, html.find('>', begin) + 1, rest.substr(0, rest.find('>') + 1)};
    const std::string_view source = tag.attribute("src"), target = tag.attribute("href");
    if (source.starts_with("data:") || target.starts_with("data:")) continue;
    if (!source.empty() || !target.empty()) return tag;
  }
  return {html.size(), html.size(), {}};
}

class PageBuilder {
 public:
  explicit PageBuilder(std::span<const PageFile> files) : files_(files) {}

  SinglePage make() {
    const std::string_view html = find("index.html").bytes;
    std::size_t at = 0;
    for (Tag tag = next_reference(html, 0); tag.begin < html.size();
         tag = next_reference(html, at)) {
      text_.append(html.substr(at, tag.begin - at));
      at = tag.end;
      if (tag.text.starts_with("<script ")) {
        take_module(tag);
        at = html.find("</script>", at);
        if (at == html.npos) throw Error("index.html", "", "has a script without an end");
        at += std::string_view("</script>").size();
      } else {
        add_link(tag);
      }
    }
    text_.append(html.substr(at));
    if (entry_.empty()) throw Error("index.html", "", "has no module");
    add_policy(text_, kSinglePagePolicy);
    // The scene stands at the end of the body: a browser shows the rest while it reads the scene.
    const std::size_t end = std::min(text_.rfind("</body>"), text_.size());
    const std::string tail = text_.substr(end);
    text_.erase(end);
    add_assets();
    return {text_,
            "</script>\n<script type=\"module\">import 'voxdag/" + entry_ + "';</script>\n" + tail};
  }

 private:
  const PageFile& find(std::string_view path) const { return file_at(files_, path, "index.html"); }

  /// Takes the page's module out of the text.
  void take_module(const Tag& tag) {
    if (tag.attribute("type") != "module" || !entry_.empty())
      throw Error("index.html", "", "must have one script with src=, a module");
    entry_ = tag.attribute("src");
  }

  /// Adds the texts that no module imports, the import map, and the start tag of the scene.
  void add_assets() {
    const std::set<std::string> modules = reachable_modules(files_, entry_);
    for (const PageFile& file : files_)
      if ((is_text(file) || is_packed(file)) && !modules.contains(std::string(file.path)))
        text_.append("<script type=\"text/plain\" data-path=\"")
            .append(file.path)
            .append("\">")
            .append(is_packed(file) ? base64(file.bytes) : file.bytes)
            .append("</script>\n");
    text_ += "<script type=\"importmap\">{\"imports\": {";
    for (const std::string& path : modules) {
      const PageFile& module = find(path);
      text_.append(path == *modules.begin() ? "\n" : ",\n")
          .append("\"voxdag/")
          .append(path)
          .append("\": \"")
          .append(data_url(module, with_bare_imports(path, module.bytes)))
          .append("\"");
    }
    text_ += "}}</script>\n<script type=\"text/plain\" id=\"scene\">";
  }

  /// Adds the style sheet or the picture that the tag refers to.
  void add_link(const Tag& tag) {
    const bool is_link = tag.text.starts_with("<link ");
    const std::string_view target = tag.attribute(is_link ? "href" : "src");
    const PageFile& file = find(target);
    if (is_link && tag.attribute("rel") == "stylesheet") {
      text_.append("<style>\n").append(file.bytes).append("</style>");
      return;
    }
    if (!file.type.starts_with("image/"))
      throw Error("index.html", "",
                  "refers to " + std::string(target) + ", which is no module, style or picture");
    std::string element(tag.text);
    element.replace(static_cast<std::size_t>(target.data() - tag.text.data()), target.size(),
                    data_url(file, file.bytes));
    text_ += element;
  }

  static bool is_text(const PageFile& file) {
    return file.path.ends_with(".js") || file.path.ends_with(".glsl");
  }

  static bool is_packed(const PageFile& file) { return file.path.ends_with(".gz"); }

  std::span<const PageFile> files_;
  std::string entry_;  // the path of the page's module
  std::string text_;
};

}  // namespace

SinglePage make_single_page(std::span<const PageFile> files) { return PageBuilder(files).make(); }

std::string make_template_page() {
  const auto [before, after] = make_single_page(BakedPage({}).files());
  return before + after;
}

void add_policy(std::string& html, std::string_view policy) {
  std::size_t at = html.find("<meta charset");
  at = html.find('>', at == std::string::npos ? html.find("<head") : at);
  if (at == std::string::npos) throw Error("index.html", "", "has no <head>");
  html.insert(at + 1, "\n<meta http-equiv=\"Content-Security-Policy\" content=\"" +
                          std::string(policy) + "\">");
}

}  // namespace voxdag
