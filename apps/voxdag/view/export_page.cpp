#include "view/export_page.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "cli/output_files.hpp"
#include "cli/written_files.hpp"
#include "viewer/site/export_site.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

namespace fs = std::filesystem;

bool is_single_file(const std::string& output) { return lower_case(output).ends_with(".html"); }

std::uint64_t write_page(const std::string& output, const SceneBytes& scene, const PageView& view,
                         Work work) {
  const BakedPage page(view);
  return is_single_file(output) ? export_single_page(output, scene, work, page.files())
                                : export_site(output, scene, work, page.files());
}

}  // namespace

bool is_page_output(const std::string& output) {
  std::error_code unknown;
  return is_single_file(output) || output.ends_with("/") || fs::is_directory(output, unknown);
}

void check_page_output(const std::string& output, const Session& session) {
  check_distinct({{"--output", output}}, session);
  if (session.subject.empty()) return;
  std::error_code unknown;
  const fs::path input = fs::weakly_canonical(session.subject, unknown);
  const fs::path folder = fs::weakly_canonical(output, unknown);
  const fs::path inside =
      input.lexically_relative(folder.has_filename() ? folder : folder.parent_path());
  if (!is_single_file(output) && !inside.empty() && *inside.begin() != "..")
    throw UsageError("--output",
                     fmt::format("is the folder of {}, an input file", session.subject));
}

void export_page(const std::string& output, const ShownSceneArguments& arguments,
                 const PageViewArguments& shown, Session& session) {
  PageView view = read_page_view(shown);
  const ShownScene scene =
      ShownScene::read(session.subject, arguments, AttributeForm::kWire, session);
  if (shown.poster) view.poster = render_poster(view, scene, &session.progress);
  const std::uint64_t bytes = write_page(output, scene.bytes(), view, &session.progress);
  print_written({{output},
                 {{"voxels", scene.voxels()}},
                 "the scene alone " + human_bytes(scene.bytes().size())},
                session);
  if (is_single_file(output) && bytes > kHandyPageBytes)
    print_warnings(
        {fmt::format("{}: has {}, which browsers open slowly: use --levels to make it smaller, or "
                     "export to a folder",
                     output, human_bytes(bytes))},
        session);
}

void export_start_page(const std::string& output, const PageViewArguments& shown,
                       Session& session) {
  PageView view = read_page_view(shown);
  // The single file has an empty scene; a folder's page must not ask for one.
  view.has_scene = is_single_file(output);
  write_page(output, NoScene(), view, &session.progress);
  print_written({{output}, {}, "a page that takes files"}, session);
}

}  // namespace voxdag::cli
