/// `voxdag view`: shows a DAG in the browser.
#include <memory>

#include "cli/commands.hpp"
#include "cli/parse.hpp"
#include "cli/scene_input.hpp"
#include "view/page_view.hpp"
#include "view/serve_scene.hpp"
#include "view/shown_scene.hpp"

namespace voxdag::cli {
namespace {

struct ViewArguments {
  SceneInput input;
  ShownSceneArguments scene;
  ServeArguments serve;
  PageViewArguments page_view;
};

void view(const ViewArguments& arguments, Session& session) {
  const BakedPage page(read_page_view(arguments.page_view));
  const ShownScene scene = ShownScene::open(session.subject, arguments.scene, session);
  serve_scene(scene.bytes(), page.files(), arguments.serve, session);
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
      "  voxdag view sponza.obj -r 4096 --keep sponza.vdag\n\n"
      "Starts a server, prints the address of the page as one line on stdout, and opens "
      "it with xdg-open if there is a display (DISPLAY or WAYLAND_DISPLAY). Ctrl-C ends "
      "the server at once.\n\n"
      "A plain file of any size is served within a second: files of up to 32 MiB are "
      "checked completely, larger ones in their header, chunk table and metadata. A "
      "compact file is decoded first. An ESVO is refused.");
  arguments->input.with_colors = true;
  add_scene_input(command, arguments->input, session, "The .vdag file, in either form");
  command.number("--port", arguments->serve.port, NumberRange::whole(0, 65535), "N",
                 "Port of the server; 0: any free one");
  command.text("--listen", arguments->serve.address, "ADDRESS",
               "Address of the server (default: 127.0.0.1, for this machine only). With another "
               "address, everyone who reaches it can read the scene");
  add_page_view_options(command, arguments->page_view);
  command.off_switch("--no-open", arguments->serve.open,
                     "Only print the page's address, without opening a browser");
  command.parsed("--memory", arguments->scene.memory_limit, parse_memory, "LIMIT",
                 "Maximum memory to decode a compact DAG, including the program (default: three "
                 "quarters of the available memory)");
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    note_page_view_files(arguments->page_view, session);
    session.work = [arguments, &session] {
      require_page_server();
      work_on_scene(arguments->input, session, [&] { view(*arguments, session); });
    };
  });
}

}  // namespace voxdag::cli
