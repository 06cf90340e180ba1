#pragma once
/// The imports of the page's modules.
#include <string>
#include <string_view>
#include <vector>

namespace voxdag {

/// The path in quotation marks of an `import`, an `export ... from` or an `await import(...)`.
struct ModuleImport {
  std::size_t begin, end;  ///< The path's place in the source, without quotation marks.
  std::string path;        ///< From the page's folder: "math.js" for '../math.js' in "gpu/a.js".
  bool is_awaited;         ///< `await import(...)`: the page may lack the file.
};

/// Returns the relative imports of the module `path`, in the order of the source. Paths that lead
/// out of the page's folder begin with "..".
std::vector<ModuleImport> module_imports(std::string_view path, std::string_view source);

/// Returns the source with each relative import replaced by "voxdag/" and its path from the page's
/// folder, which an import map can name.
std::string with_bare_imports(std::string_view path, std::string_view source);

}  // namespace voxdag
