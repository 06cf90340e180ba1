#pragma once
/// Exports a scene as a page of the viewer: a folder or one .html file.
#include <string>

#include "cli/session.hpp"
#include "view/page_view.hpp"
#include "view/shown_scene.hpp"

namespace voxdag::cli {

/// Returns whether `output` names a page: it ends in ".html" or "/", or is a folder.
bool is_page_output(const std::string& output);

/// Throws UsageError if the page would replace an input, or the folder of an input.
void check_page_output(const std::string& output, const Session& session);

/// Writes the page with the scene of session.subject, which it shows as `shown` says. Prints its
/// size, and a warning if it is one large file.
void export_page(const std::string& output, const ShownSceneArguments& arguments,
                 const PageViewArguments& shown, Session& session);

/// Writes the page without a scene: it begins with a place to drop files.
void export_start_page(const std::string& output, const PageViewArguments& shown, Session& session);

}  // namespace voxdag::cli
