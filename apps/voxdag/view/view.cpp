/// `voxdag view`: shows a DAG in the browser.
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/parse.hpp"
#include "cli/scene_input.hpp"
#include "view/page_view.hpp"
#include "view/serve_scene.hpp"
#include "view/shown_scene.hpp"
#include "viewer/edit/save_edited.hpp"
#include "viewer/site/single_page.hpp"
#include "voxdag/file/vdag_container.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"

namespace voxdag::cli {
namespace {

struct ViewArguments {
  SceneInput input;
  ShownSceneArguments scene;
  ServeArguments serve;
  PageViewArguments page_view;
  bool edits = false;
  std::string output;  ///< The file that saving suggests; empty: beside the input.
};

/// Serves the page, and the template in which it saves scenes as pages.
void serve_page(const SceneBytes& scene, const PageView& shown, const ViewArguments& arguments,
                Session& session) {
  const BakedPage page(shown);
  std::vector<PageFile> files(page.files().begin(), page.files().end());
  std::string single;
  if (has_program(files)) {
    single = make_template_page();
    files.push_back({kTemplateName, "text/html; charset=utf-8", single});
  }
  serve_scene(scene, files, arguments.serve, session);
}

void view(const ViewArguments& arguments, Session& session) {
  const PageView shown = read_page_view(arguments.page_view);
  const ShownScene scene = ShownScene::open(session.subject, arguments.scene, session);
  serve_page(scene.bytes(), shown, arguments, session);
}

/// Shows the start page.
void view_nothing(const ViewArguments& arguments, Session& session) {
  PageView shown = read_page_view(arguments.page_view);
  shown.has_scene = false;
  serve_page(NoScene(), shown, arguments, session);
}

/// Returns the file that saving suggests for an input: "FOLDER/NAME-edited.vdag".
std::filesystem::path edited_name(const std::filesystem::path& input) {
  return input.parent_path() / (input.stem().string() + "-edited.vdag");
}

void edit(const ViewArguments& arguments, const std::filesystem::path& output, Session& session) {
  PageView shown = read_page_view(arguments.page_view);
  shown.edits = true;
  const BakedPage page(shown);
  const bool is_compact = vdag_kind(session.subject) == VdagKind::kCompact;
  ShownSceneArguments read = arguments.scene;
  read.for_edits = true;
  const ShownScene scene = ShownScene::read(session.subject, read, AttributeForm::kPages, session);
  const ReducedDag& dag = scene.dag();
  const Work work(scene.memory(), &session.progress);
  const auto save = [&](const EditSnapshot& version, const std::filesystem::path& path) {
    save_edited(version, dag.metadata(), path, is_compact, work);
  };
  EditSession editing({dag.dag(), dag.attributes()}, dag.metadata().grid, output, save, work,
                      scene.is_seeded());
  serve_scene(scene.bytes(), page.files(), arguments.serve, session, &editing);
}

}  // namespace

void add_view_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<ViewArguments>();
  const Command command = program.add(
      "view", "Show a DAG in the browser",
      "voxdag view scene.vdag\n"
      "  voxdag view scene.vdag --port 8080 --no-open\n"
      "  voxdag view scene.vdag --view scene.settings.json\n"
      "  voxdag view scene.vdag --environment studio\n"
      "  voxdag view castle.vox\n"
      "  voxdag view sponza.obj -r 4096 --keep sponza.vdag\n"
      "  voxdag view --edit scene.vdag\n\n"
      "Starts a server, prints the address of the page as one line on stdout, and opens "
      "it with xdg-open if there is a display (DISPLAY or WAYLAND_DISPLAY). Ctrl-C ends "
      "the server at once. Without FILE, the page begins with a place to drop one.\n\n"
      "A plain file of any size is served within a second: files of up to 32 MiB are "
      "checked completely, larger ones in their header, chunk table and metadata. A "
      "compact file is decoded first. An ESVO is refused.\n\n"
      "With --edit, the page has brushes. The scene is read into memory, and edits stay there "
      "until the page saves them to a file. The address then ends in a secret: who knows it may "
      "edit, so pass it to nobody. One window edits at a time.");
  arguments->input.with_colors = true;
  add_scene_input(command, arguments->input, session, "The .vdag file, in either form", false);
  command.number("--port", arguments->serve.port, NumberRange::whole(0, 65535), "N",
                 "Port of the server; 0: any free one");
  command.text("--listen", arguments->serve.address, "ADDRESS",
               "Address of the server (default: 127.0.0.1, for this machine only). With another "
               "address, everyone who reaches it can read the scene");
  add_page_view_options(command, arguments->page_view);
  const Option edits = command.flag(
      "--edit", arguments->edits,
      "Edit the scene in the browser: brushes that add, remove and paint voxels, undo, save");
  command
      .text("-o,--output", arguments->output, "OUT.vdag",
            "File that the page's button \"Save as\" suggests; files are saved only in its folder "
            "(default: FILE-edited.vdag in the folder of FILE)")
      .needs(edits);
  command.off_switch("--no-open", arguments->serve.open,
                     "Only print the page's address, without opening a browser");
  command.parsed("--memory", arguments->scene.memory_limit, parse_memory, "LIMIT",
                 "Maximum memory to decode a compact DAG or to edit, including the program "
                 "(default: three quarters of the available memory)");
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    note_page_view_files(arguments->page_view, session);
    session.work = [arguments, &session] {
      check_vdag_name(arguments->output);
      require_page_server();
      if (session.subject.empty()) {
        if (arguments->edits) throw UsageError("--edit", "needs a FILE");
        return view_nothing(*arguments, session);
      }
      const std::filesystem::path input = session.subject, output = arguments->output;
      work_on_scene(arguments->input, session, [&] {
        if (arguments->edits)
          edit(*arguments, output.empty() ? edited_name(input) : output, session);
        else
          view(*arguments, session);
      });
    };
  });
}

}  // namespace voxdag::cli
