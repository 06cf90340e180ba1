#include "voxdag/formats/readers/named_files.hpp"

#include <algorithm>

#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/core/utf8.hpp"
#include "voxdag/formats/readers/gltf/gltf_uri.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// Returns the absolute path, with symbolic links resolved as far as it exists.
fs::path resolved(const fs::path& path) {
  std::error_code failed;
  // weakly_canonical() leaves a relative path relative if no part of it exists.
  fs::path result = fs::weakly_canonical(fs::absolute(path), failed);
  // A path that cannot be resolved (a loop of links, a name too long) cannot be opened either.
  return failed ? fs::absolute(path, failed).lexically_normal() : result;
}

bool is_inside(const fs::path& path, const fs::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_directory(path, ignored);
}

/// Returns a name without quotes around it, with '/' between folders.
std::string cleaned(std::string_view name) {
  name = trim(name);
  for (const char quote : {'"', '\''})
    if (name.size() > 1 && name.front() == quote && name.back() == quote)
      name = name.substr(1, name.size() - 2);
  std::string clean(name);
  std::replace(clean.begin(), clean.end(), '\\', '/');
  return clean;
}

/// Returns whether a cleaned name begins with a drive of Windows.
bool has_drive(std::string_view name) {
  return name.size() > 2 && name[1] == ':' && name[2] == '/';
}

/// Returns whether a cleaned name is absolute on any system.
bool is_absolute(std::string_view name) {
  return name.starts_with('/') || has_drive(name) || name.find("://") != name.npos;
}

/// Returns the ends of a cleaned name that are names themselves, the longest of at most
/// kMaxFolders folders first and the base name last.
std::vector<std::string_view> ends_of(std::string_view name) {
  constexpr std::size_t kMaxFolders = 8;
  std::vector<std::string_view> ends;
  for (std::size_t slash = name.size(); slash > 0 && ends.size() <= kMaxFolders;) {
    slash = name.rfind('/', slash - 1);
    if (slash == name.npos) slash = 0;
    const std::string_view end = name.substr(slash + (name[slash] == '/' ? 1 : 0));
    if (!end.starts_with('/')) ends.push_back(end);
  }
  std::reverse(ends.begin(), ends.end());
  return ends;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = utf8_character_bytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

/// Returns the text, whose bytes are characters of Latin-1, as UTF-8.
std::string utf8_of_latin1(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80) utf8 += static_cast<char>(0xC0 | byte >> 6);
    utf8 += byte < 0x80 ? c : static_cast<char>(0x80 | (byte & 0x3F));
  }
  return utf8;
}

/// Returns the other spellings of a cleaned name: with %20 and the like, or in Latin-1.
std::vector<std::string> spellings_of(const std::string& name) {
  std::vector<std::string> spellings{name};
  if (name.find('%') != name.npos) spellings.push_back(decode_percent(name));
  if (!is_utf8(name)) spellings.push_back(utf8_of_latin1(name));
  return spellings;
}

/// Returns the file `folder` / `name` in any letter case; the first by name if there are several,
/// and an empty path if there is none.
fs::path in_any_case(const fs::path& folder, const fs::path& name) {
  fs::path found = folder;
  for (const fs::path& part : name) {
    std::error_code failed;
    if (fs::exists(found / part, failed)) {
      found /= part;
      continue;
    }
    std::string best;
    const std::string wanted = lower_case(part.native());
    for (fs::directory_iterator at(found.empty() ? "." : found, failed), end; !failed && at != end;
         at.increment(failed)) {
      const std::string each = at->path().filename().string();
      if (lower_case(each) == wanted && (best.empty() || each < best)) best = each;
    }
    if (best.empty()) return {};
    found /= best;
  }
  return is_file(found) ? found : fs::path();
}

}  // namespace

NamedFiles::NamedFiles(const MeshSource& source)
    : options_(source.options),
      folder_(source.folder),
      root_(resolved(source.folder.empty() ? "." : source.folder)) {}

bool NamedFiles::is_allowed(const fs::path& path) const {
  return options_.allow_outside || is_inside(resolved(path), root_);
}

/// Returns the file that an end of `name`, the longest first, names in `folder` or in the mesh
/// file's folder.
std::optional<fs::path> NamedFiles::with_end_of(const fs::path& folder,
                                                std::string_view name) const {
  for (const std::string& spelling : spellings_of(cleaned(name)))
    for (const std::string_view end : ends_of(spelling))
      for (const fs::path& each : {folder, folder_})
        if (fs::path path = in_any_case(each, end); !path.empty() && is_allowed(path)) return path;
  return std::nullopt;
}

std::optional<fs::path> NamedFiles::existing(const fs::path& folder, std::string_view name,
                                             ByBaseName by_base_name) const {
  const std::string clean = cleaned(name);
  for (const std::string_view each : {name, std::string_view(clean)})
    if (fs::path path = folder / each; is_file(path) && is_allowed(path)) return path;
  if (!is_absolute(clean))
    for (const std::string& spelling : spellings_of(clean))
      if (fs::path path = in_any_case(folder, spelling); !path.empty() && is_allowed(path))
        return path;
  const bool stands_for_base_name = by_base_name == ByBaseName::kAlways ||
                                    (by_base_name == ByBaseName::kIfAbsolute && is_absolute(clean));
  return stands_for_base_name ? with_end_of(folder, name) : std::nullopt;
}

fs::path NamedFiles::find(const fs::path& folder, std::string_view name, const NamePlace& place,
                          ByBaseName by_base_name) const {
  std::optional<fs::path> path = existing(folder, name, ByBaseName::kNever);
  if (!path && (path = existing(folder, name, by_base_name)) && base_names_++ == 0)
    first_base_name_ = name_in_quotes(name);
  if (!path) {
    const std::string clean = cleaned(name);
    path = folder / (has_drive(clean) ? clean.substr(clean.rfind('/') + 1) : clean);
    if (name.find("://") != name.npos)
      throw Error(place.file, place.place, name_in_quotes(name) + " is not a file beside the mesh");
    if (!is_allowed(*path))
      throw Error(place.file, place.place,
                  name_in_quotes(name) + " is outside of the folder of the mesh file");
  }
  report(*path);
  return *path;
}

void NamedFiles::report(const fs::path& path) const {
  if (options_.named_files != nullptr) options_.named_files->push_back(path);
}

std::optional<std::string> NamedFiles::warning(const std::string& file) const {
  if (base_names_ == 0) return std::nullopt;
  return file + ": " + std::to_string(base_names_) +
         " names of files stand for files of the same name in or below the mesh's folder: the "
         "first is " +
         first_base_name_;
}

std::string printable_path(const fs::path& folder, std::string_view name) {
  return (folder / printable(name)).string();
}

}  // namespace voxdag
