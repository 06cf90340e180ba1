#pragma once
/// Chooses the importers of assimp that may read a file.
#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

namespace voxdag {

/// An importer of assimp that survived fuzzing. The fuzzing was coverage-guided, under
/// AddressSanitizer, with assimp 5.2.5 (the version of Debian 12), for 50 s and 4,000 to 65,000
/// inputs per importer. Those for Collada, FBX, 3DS, X, LWO, ASE, AC3D, MD3, MDL, NFF, RAW, SIB,
/// COB, 3MF, B3D, OpenGEX, SMD, HMP, Q3D, LWS, CSM and MD5 failed: they read or wrote outside their
/// memory, freed it twice, allocated gigabytes, ended the process, or took more than 8 s for at
/// most 60 KB. The other importers were not tested, or they read files that the mesh names with any
/// importer.
struct SafeImporter {
  std::string_view extensions;  ///< In assimp's form: they identify the importer.
  std::string_view extension;   ///< The extension that may be read.
};

inline constexpr std::array<SafeImporter, 7> kSafeImporters{{{"amf", ".amf"},
                                                             {"dxf", ".dxf"},
                                                             {"md2", ".md2"},
                                                             {"ms3d", ".ms3d"},
                                                             {"x3d x3db", ".x3d"},
                                                             {"xgl zgl", ".xgl"},
                                                             {"xml irrmesh", ".irrmesh"}}};

/// Returns whether the importer that lists these extensions is one of kSafeImporters.
inline bool is_safe_importer(std::string_view extensions) {
  return std::any_of(
      kSafeImporters.begin(), kSafeImporters.end(),
      [extensions](const SafeImporter& safe) { return safe.extensions == extensions; });
}

/// Returns whether files of this extension (".dxf", any case) may be read without --assimp any.
/// Files without an extension may be read too: then only safe importers inspect them.
inline bool is_safe_extension(std::string extension) {
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension.empty() ||
         std::any_of(kSafeImporters.begin(), kSafeImporters.end(),
                     [&](const SafeImporter& safe) { return safe.extension == extension; });
}

}  // namespace voxdag
