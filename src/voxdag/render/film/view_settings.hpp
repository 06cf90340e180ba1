#pragma once
/// Reads the settings that the viewer saves as JSON, for `render --view`.
#include <optional>
#include <string>
#include <vector>

#include "voxdag/render/render_options.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag {

struct ViewSettings {
  /// The camera, the light, the level of detail and the section of the view; other members have
  /// their defaults.
  RenderOptions options;
  bool colors = true, normals = true;  ///< Show the colours, the normals that the scene stores.
  std::string channel;                 ///< Show the values of this channel as colours; empty: none.
  std::optional<ChannelRange> channel_range;  ///< The values of the first and the last colour.
  std::string title, licence;                 ///< Of a page; UTF-8, empty if the file has none.
  /// A warning for each setting that a picture cannot show and for each unknown key, such as
  /// "\"level\" is ignored: a picture shows the finest level".
  std::vector<std::string> ignored;
  std::vector<std::string> unknown;  ///< The unknown keys, such as "sun.colour".
};

/// Reads at most 16 MiB of JSON. docs/viewer.md lists the keys; missing keys have their defaults.
/// Throws Error for a value of the wrong type or out of range, and for another version. The reason
/// names the key.
ViewSettings read_view_settings(const std::string& file);

/// Reads settings from a text that is JSON. `name` is its name in errors. Throws what
/// read_view_settings() throws.
ViewSettings parse_view_settings(const std::string& text, const std::string& name);

}  // namespace voxdag
