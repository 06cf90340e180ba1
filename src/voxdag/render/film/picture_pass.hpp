#pragma once
/// The passes of a picture: values per pixel that can be written to files.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/image/image.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// One kind of values, such as depth.
struct PictureKind {
  std::string_view name;
  std::vector<std::string> channels;         ///< Names of the channels in an EXR.
  ImageF (*values)(const RenderedImage&);    ///< Returns the values for an EXR.
  ImageRgb8 (*shown)(const RenderedImage&);  ///< Returns the pixels of a PNG.
  bool RenderOptions::*needs = nullptr;      ///< The option that must be set, or null.
};

/// Returns the table of all kinds. EXR holds the values: "picture", tone mapped in linear light;
/// "radiance"; "depth", world units (Z); "normal" (N.X N.Y N.Z); "occlusion", "shadow" and "steps";
/// "albedo", the linear diffuse colour; "voxel", the lowest voxel of the cell and its level
/// (voxel.X voxel.Y voxel.Z voxel.level), -1 where none is; "material", ids, -1 where none is. PNG
/// shows them: picture, radiance and albedo in sRGB; depth from white (nearest) to dark grey, and
/// black for the background; normals as (n + 1) / 2; steps as a heat map up to their maximum;
/// voxels and materials each in a colour of its own. "steps64" has the values of "steps", and shows
/// them in grey up to 64.
std::span<const PictureKind> picture_kinds();

/// Returns the kind with this name, or null.
const PictureKind* find_picture_kind(std::string_view name);

/// One kind of values, and the file that they are written to.
struct PicturePass {
  const PictureKind* kind = nullptr;
  std::string path;  ///< File of one picture; for a film a pattern (frame_names.hpp).
};

/// Returns whether the path ends in .png or .exr.
bool is_picture_path(const std::string& path);

/// Writes the values of `kind` from `image` to `path`, which must end in .png or .exr. Throws Error
/// if the file cannot be written.
void write_pass(const PictureKind& kind, const std::string& path, const RenderedImage& image);

}  // namespace voxdag
