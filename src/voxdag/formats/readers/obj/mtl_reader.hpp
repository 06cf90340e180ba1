#pragma once
/// MTL, the material files of Wavefront OBJ.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/named_files.hpp"
#include "voxdag/formats/readers/warnings.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Fills materials from MTL files, by name, and adds the images that they use.
///
/// Reads Kd and Ke (as sRGB), map_Ke, d, Tr where there is no d, map_Kd, map_d, norm, bump
/// (map_bump) with -bm, disp (map_disp) with -mm, Pm, Pr, map_Pm and map_Pr, and for each map -s,
/// -o and -clamp; ignores other statements and options. If there is a map_Kd, it alone gives the
/// colour; Kd replaces it if the image cannot be read. A map_d, or a map_Kd without d below 1,
/// makes the material a mask; a map_Kd whose alpha hides everything does not. A Tr that alone would
/// hide the material is taken for a fault: the material is opaque, with a warning. A malformed
/// statement is a warning that names its line and its replacement.
class MtlReader {
 public:
  /// `appearance` has the materials, with distinct names. The references must stay valid.
  MtlReader(const MeshSource& source, const NamedFiles& files, Appearance& appearance,
            Warnings& warnings);
  ~MtlReader();

  /// Reads the text of one file. Names of images are relative to `folder`. `name` names the file in
  /// messages. Throws OverMemory and Cancelled.
  void read(std::string_view text, const std::filesystem::path& folder, const std::string& name);

  /// Completes appearance.materials[material] after all files are read: if none describes its name,
  /// the description of an equal name without quotes and comments counts. Returns whether there is
  /// a description.
  bool complete(std::size_t material);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace voxdag
