#pragma once
/// The settings that the viewer saves as JSON: `render --view` reads them.
#include <string>
#include <vector>

#include "voxdag/render/render_options.hpp"

namespace voxdag {

struct ViewSettings {
  /// The camera, the light and the level of detail of the view; other members have their defaults.
  RenderOptions options;
  bool colors = true, normals = true;  ///< Show those of the file.
  /// What a picture cannot show, and keys that nobody knows: "\"level\" is ignored: ...".
  std::vector<std::string> ignored;
};

/// Reads at most 16 MiB of JSON. docs/viewer.md lists the keys; those that are missing have their
/// defaults. Throws Error(file, key, reason) for a value of the wrong type or out of range, for
/// another version, and for a section, which a picture cannot show.
ViewSettings read_view_settings(const std::string& file);

}  // namespace voxdag
