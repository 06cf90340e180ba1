#pragma once
/// The passes of a picture: the values behind it that can be written as files.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/image/image.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// One kind of values.
struct PictureKind {
  std::string_view name;
  std::vector<std::string> channels;         ///< Their names in an EXR.
  ImageF (*values)(const RenderedImage&);    ///< Returns what an EXR holds.
  ImageRgb8 (*shown)(const RenderedImage&);  ///< Returns what a PNG shows.
  bool needs_steps = false;                  ///< Whether RenderOptions::with_steps must be set.
};

/// The table of all kinds. EXR holds the values: "picture", tone mapped in linear light;
/// "radiance"; "depth", world units (Z); "normal" (N.X N.Y N.Z); "occlusion", "shadow" and "steps".
/// PNG shows them: picture and radiance in sRGB; depth from white (nearest) to dark grey, and black
/// where nothing is; normals as (n + 1) / 2; steps as a heat map up to their maximum.
std::span<const PictureKind> picture_kinds();

/// Returns the kind of that name, or null.
const PictureKind* find_picture_kind(std::string_view name);

/// One kind of values, and the file that they are written to.
struct PicturePass {
  const PictureKind* kind = nullptr;
  std::string path;  ///< Of one picture; for a film a pattern (frame_names.hpp).
};

/// Whether the path ends in .png or .exr.
bool is_picture_path(const std::string& path);

/// Writes values of `image` to `path`, which is_picture_path() accepts. Throws Error.
void write_pass(const PictureKind& kind, const std::string& path, const RenderedImage& image);

}  // namespace voxdag
