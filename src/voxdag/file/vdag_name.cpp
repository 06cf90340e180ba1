#include "voxdag/file/vdag_name.hpp"

#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/lower_case.hpp"

namespace voxdag {
namespace {

/// The endings in formats/exports/export_voxels.cpp, which this room does not include.
/// tests/cli/written_output_test.cpp compares both. Longer endings, such as .spc.npy, end in one of
/// these.
constexpr std::string_view kOtherFormats[] = {
    ".npy",        ".raw",  ".ply", ".glb", ".obj", ".stl", ".3mf",    ".vox", ".binvox", ".schem",
    ".voxel.json", ".nrrd", ".mha", ".mhd", ".vti", ".nii", ".nii.gz", ".vdb", ".nvdb",   ".html"};

}  // namespace

void check_vdag_name(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  const auto ends_in = [&](std::string_view ending) {
    return name.size() > ending.size() && name.ends_with(ending);
  };
  if (ends_in(".esvo"))
    throw Error(path.string(), "",
                "the file would be a DAG, and .esvo is for ESVOs, which `voxdag build` makes of "
                "meshes: end the name in .vdag (other formats: voxdag export)");
  for (const std::string_view ending : kOtherFormats)
    if (ends_in(ending))
      throw Error(path.string(), "",
                  "the file would be a DAG, not a " + std::string(ending) +
                      " file: end the name in .vdag, and write other formats with voxdag export");
}

}  // namespace voxdag
