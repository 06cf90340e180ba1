#pragma once
/// The options of a page's first view: `--view`, `--title` and `--poster`.
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "view/shown_scene.hpp"
#include "viewer/embedded/baked_page.hpp"

namespace voxdag::cli {

struct PageViewArguments {
  std::string file, title;
  bool poster = false;
};

/// Adds --view and --title. Returns them.
std::vector<Option> add_page_view_options(const Command& command, PageViewArguments& arguments);

/// Reads the settings of --view. Throws Error, which names the file and the key, for a value that
/// the page could not use, and for an unknown key.
PageView read_page_view(const PageViewArguments& arguments);

/// Renders the picture of --poster, as a data URL of a JPEG of some 20 KB. `scene` comes from
/// ShownScene::read(). Throws what render_image() throws.
std::string render_poster(const PageViewArguments& arguments, const ShownScene& scene, Work work);

}  // namespace voxdag::cli
