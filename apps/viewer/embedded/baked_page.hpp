#pragma once
/// A page that begins with a given view of its scene.
#include <string>
#include <vector>

#include "viewer/embedded/page_files.hpp"

namespace voxdag {

/// The settings, title and poster with which a page begins. The page chooses what is empty.
struct PageView {
  std::string settings;   ///< JSON as the page saves it: voxdag/render/film/view_settings.hpp.
  std::string title;      ///< Of the page, until it has read its settings.
  bool has_scene = true;  ///< Otherwise it begins with the start page, which takes files.
  bool edits = false;     ///< The server edits the scene.
  std::string poster;     ///< Data URL of a picture that is shown until the scene has arrived.
};

/// The files of the page, in which index.html has the view; without those of edit/ if neither the
/// server nor a program in the page edits. The files refer to this object.
class BakedPage {
 public:
  explicit BakedPage(const PageView& view);
  BakedPage(const BakedPage&) = delete;
  BakedPage& operator=(const BakedPage&) = delete;
  ~BakedPage() = default;

  std::span<const PageFile> files() const { return files_; }

 private:
  std::string index_;
  std::vector<PageFile> files_;
};

}  // namespace voxdag
