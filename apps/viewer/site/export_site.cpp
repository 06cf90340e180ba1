#include "viewer/site/export_site.hpp"

#include <set>
#include <string_view>
#include <system_error>

#include "viewer/gzip/gzip.hpp"
#include "viewer/site/scene_pieces.hpp"
#include "viewer/site/single_page.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/base64.hpp"
#include "voxdag/core/io/temporary_folder.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

constexpr char kSceneName[] = "scene.vdag";

[[noreturn]] void fail(const fs::path& path, const std::string& what,
                       const std::error_code& error) {
  throw Error(path.string(), "", what + ": " + error.message());
}

/// Throws Error if a folder has files that are not of a page.
void check_replaceable(const fs::path& folder) {
  std::set<fs::path> ours = {kSceneName, kTemplateName};
  for (const PageFile& file : page_files())
    for (fs::path path = file.path; !path.empty(); path = path.parent_path()) ours.insert(path);
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    const fs::path path = at->path().lexically_relative(folder);
    if (!ours.contains(path) || at->is_symlink())
      throw Error(folder.string(), "",
                  "has " + path.string() + ", which is no file of the page: name a new folder");
  }
  if (error) fail(folder, "cannot read", error);
}

void write_scene(const fs::path& path, const SceneBytes& scene, Work work) {
  AtomicFile file(path);
  for_each_piece(scene, work, [&](std::span<const std::byte> piece) { file.write(piece); });
  file.commit();
}

}  // namespace

std::uint64_t export_site(const fs::path& folder, const SceneBytes& scene, Work work,
                          std::span<const PageFile> files) {
  const fs::path target = folder.has_filename() ? folder : folder.parent_path();
  std::error_code error;
  const fs::file_status status = fs::symlink_status(target, error);
  if (fs::exists(status)) {
    if (!fs::is_directory(status)) throw Error(target.string(), "", "exists and is no folder");
    check_replaceable(target);
  }
  const TemporaryFolder site(target);
  std::uint64_t bytes = scene.size();
  for (const PageFile& file : files) {
    const fs::path path = site.path() / file.path;
    fs::create_directories(path.parent_path(), error);
    if (error) fail(target, "cannot create", error);
    std::string text(file.bytes);
    if (file.path == "index.html") add_policy(text, kPagePolicy);
    write_whole_file(path, text);
    bytes += text.size();
  }
  if (has_program(files)) {
    const std::string text = make_template_page();
    write_whole_file(site.path() / kTemplateName, text);
    bytes += text.size();
  }
  if (scene.size() > 0) write_scene(site.path() / kSceneName, scene, work);
  site.take_name();
  return bytes;
}

std::uint64_t export_single_page(const std::filesystem::path& path, const SceneBytes& scene,
                                 Work work, std::span<const PageFile> files) {
  const SinglePage page = make_single_page(files);
  AtomicFile file(path);
  file.write(page.before);
  if (scene.size() > 0) {
    Gzip gzip;
    Base64 encoder;
    const auto write = [&](std::string_view compressed) { file.write(encoder.add(compressed)); };
    for_each_piece(scene, work, [&](auto piece) { gzip.add(piece, write); });
    gzip.finish(write);
    file.write(encoder.finish());
  }
  file.write(page.after);
  const std::uint64_t bytes = file.position();
  file.commit();
  return bytes;
}

}  // namespace voxdag
