#pragma once
/// Makes one HTML text of the page and all that it needs.
#include <span>
#include <string>

#include "viewer/embedded/page_files.hpp"

namespace voxdag {

/// The text before and after the scene, which is the base64 of a gzip of the .vdag file.
struct SinglePage {
  std::string before, after;
};

/// Makes the page from its files, which include "index.html" and its one module. The result holds
///   modules      as data: URLs in an import map, which names them "voxdag/PATH"
///   texts that no module imports (shaders, the worker)
///                as elements <script type="text/plain" data-path="PATH">
///   gzip files   likewise, as base64
///   style sheets as elements <style>, and pictures as data: URLs
///   the scene    as the element <script type="text/plain" id="scene">
/// It makes no connection, and its policy forbids all. Throws Error for a page that cannot become
/// one file: it lacks a file that a module imports, or refers to a file of another type.
SinglePage make_single_page(std::span<const PageFile> files);

}  // namespace voxdag
