#pragma once
/// The files of the page, which the build embeds into the program.
#include <span>
#include <string_view>

namespace voxdag {

struct PageFile {
  std::string_view path;  ///< Path from the page's folder: "app/app.js", or "index.html".
  std::string_view type;  ///< Content-Type.
  std::string_view bytes;
};

/// Returns the files, sorted by path. They live as long as the program.
std::span<const PageFile> page_files();

/// The Content-Security-Policy of a page on a host. Allows only what the page needs: files of that
/// host; a worker and pictures that the page makes itself (blob:); pictures in its style sheet
/// (data:); the program that builds, in WebAssembly. Forbids inline scripts and styles.
inline constexpr std::string_view kPagePolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; "
    "connect-src 'self' blob: data:; style-src 'self'; img-src 'self' data: blob:; "
    "font-src 'self'; base-uri 'none'; form-action 'none'";

/// Returns whether the page can build scenes: it has the program for browsers.
bool has_program(std::span<const PageFile> files);

/// Returns the file with this path, or null.
const PageFile* find_page_file(std::string_view path);

}  // namespace voxdag
