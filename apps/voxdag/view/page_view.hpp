#pragma once
/// The options of a page's first view: `--view`, `--title`, `--environment` and `--poster`.
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "view/shown_scene.hpp"
#include "viewer/embedded/baked_page.hpp"

namespace voxdag::cli {

struct PageViewArguments {
  std::string file, title, environment;
  bool poster = false;
};

/// Adds --view, --title and --environment. Returns them.
std::vector<Option> add_page_view_options(const Command& command, PageViewArguments& arguments);

/// Adds the files that the options name to session.inputs.
void note_page_view_files(const PageViewArguments& arguments, Session& session);

/// Reads the settings of --view and the environment. Throws Error, which names the file and the
/// key, for a value that the page could not use, and for an unknown key.
PageView read_page_view(const PageViewArguments& arguments);

/// Renders the first view, as a data URL of a JPEG of some 20 KB. `scene` comes from
/// ShownScene::read(). Throws what render_image() throws.
std::string render_poster(const PageView& view, const ShownScene& scene, Work work);

}  // namespace voxdag::cli
