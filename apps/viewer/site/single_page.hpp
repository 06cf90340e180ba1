#pragma once
/// The page and all that it needs in one HTML text.
#include <span>
#include <string>

#include "viewer/embedded/page_files.hpp"

namespace voxdag {

/// The text before and after the scene, which is the base64 of a gzip of the .vdag file.
struct SinglePage {
  std::string before, after;
};

/// Makes the page from its files, among which are "index.html" and its one module. In the result
///   the modules are data: URLs in an import map, which names them "voxdag/PATH";
///   files that no module imports (shaders, the worker) are elements
///     <script type="text/plain" data-path="PATH">;
///   style sheets are elements, and pictures are data: URLs;
///   the scene is the element <script type="text/plain" id="scene">.
/// It makes no connection, and its policy forbids any. Throws Error for a page that cannot become
/// one file: an import of a file that it lacks, a reference that is none of these.
SinglePage make_single_page(std::span<const PageFile> files);

}  // namespace voxdag
