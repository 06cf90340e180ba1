/// Replaces view/export_page.cpp: the viewer's page writes pages itself.
#include "view/export_page.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {

bool is_page_output(const std::string& output) {
  return output.ends_with(".html") || output.ends_with("/");
}

void check_page_output(const std::string&, const Session&) {}

void export_start_page(const std::string& output, const PageViewArguments&, Session&) {
  throw Error(output, "", "the page itself saves pages");
}

void export_page(const std::string& output, const ShownSceneArguments&, const PageViewArguments&,
                 Session&) {
  throw Error(output, "", "this voxdag writes no pages: its viewer does");
}

std::vector<Option> add_page_view_options(const Command&, PageViewArguments&) { return {}; }

void note_page_view_files(const PageViewArguments&, Session&) {}

}  // namespace voxdag::cli
