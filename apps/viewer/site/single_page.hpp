#pragma once
/// Makes one HTML text of the page and all that it needs.
#include <span>
#include <string>
#include <string_view>

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

/// The page in one file without a scene: the page saves scenes in copies of it.
inline constexpr char kTemplateName[] = "voxdag.html";

/// Returns the text of that file.
std::string make_template_page();

/// Adds a Content-Security-Policy to an HTML text, behind <meta charset>; if there is none, behind
/// <head>. Throws Error for a text without <head>.
void add_policy(std::string& html, std::string_view policy);

}  // namespace voxdag
