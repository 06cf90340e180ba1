#include "voxdag/formats/readers/obj/obj_materials.hpp"

#include <algorithm>
#include <optional>

#include "voxdag/formats/readers/named_files.hpp"
#include "voxdag/formats/readers/obj/mtl_reader.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kLargestMtlBytes = std::size_t{64} << 20;

/// Replaces the separators of Windows in a name.
std::string with_slashes(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '\\', '/');
  return out;
}

/// Calls body(name) for each file that the argument of `mtllib` names: one file with blanks in its
/// name, or several files.
template <class Body>
void for_each_library(const MeshSource& source, const NameTable& libraries, const Body& body) {
  for (std::size_t i = 0; i < libraries.size(); ++i) {
    const std::string whole = with_slashes(libraries[i]);
    std::error_code ignored;
    if (std::filesystem::exists(source.folder / whole, ignored)) {
      body(whole);
      continue;
    }
    std::string_view rest = whole;
    for (std::string_view name; !(name = next_token(rest)).empty();) body(name);
  }
}

/// Opens an MTL file. On failure adds a warning and returns nothing.
std::optional<MappedFile> open_library(const std::filesystem::path& path,
                                       const std::string& printed, Warnings& warnings) {
  try {
    return MappedFile(path, MappedFile::Access::kSequential, {kLargestMtlBytes, "an MTL file"});
  } catch (const Error& error) {
    warnings.add(printed + ": " + error.reason() + ": its materials are grey");
    return std::nullopt;
  }
}

}  // namespace

std::vector<std::string> read_obj_materials(const MeshSource& source, const Mesh& mesh,
                                            const NameTable& libraries, std::size_t bad_references,
                                            Appearance& appearance) {
  Warnings warnings;
  if (bad_references > 0)
    warnings.add(source.name + ": " + std::to_string(bad_references) +
                 " corners of faces name texture coordinates or normals that do not exist: "
                 "these corners have none");
  std::vector<Material>& materials = appearance.materials;
  const std::size_t count = std::max<std::size_t>(mesh.materials.size(), 1);
  // Counts the material and its name, here and in the MTL reader's table.
  std::uint64_t bytes = count * sizeof(Material);
  for (const std::string& name : mesh.materials) bytes += name.size() + 1;
  const MemoryReservation memory(source.work().memory, bytes);
  materials.resize(count);
  for (std::size_t i = 0; i < mesh.materials.size(); ++i) materials[i].name = mesh.materials[i];
  for (Material& material : materials) material.base_color = kDefaultColor;

  const NamedFiles files(source);
  MtlReader reader(source, files, appearance, warnings);
  NameTable seen(source.work().memory);
  for_each_library(source, libraries, [&](std::string_view name) {
    const std::filesystem::path path = files.find(source.folder, name, {source.name, "mtllib"});
    const std::string key = path.lexically_normal().string();
    if (seen.find(key)) return;
    seen.find_or_add(key);
    const std::string printed = printable_path(source.folder, name);
    if (const auto file = open_library(path, printed, warnings))
      reader.read(file->text(), path.parent_path(), printed);
  });
  for (std::size_t i = 0; i < materials.size() && !libraries.empty(); ++i)
    if (!materials[i].name.empty() && !reader.describes(i))
      warnings.add(source.name + ": no MTL file describes material " +
                   name_in_quotes(materials[i].name) + ": it is grey");
  return warnings.take(source.name);
}

void report_obj_libraries(const MeshSource& source, const NameTable& libraries) {
  if (source.options.named_files == nullptr) return;
  const NamedFiles files(source);
  for_each_library(source, libraries,
                   [&](std::string_view name) { files.report(source.folder / name); });
}

}  // namespace voxdag
