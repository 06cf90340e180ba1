#include "voxdag/formats/readers/obj/obj_materials.hpp"

#include <algorithm>
#include <optional>

#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/readers/named_files.hpp"
#include "voxdag/formats/readers/obj/mtl_map.hpp"
#include "voxdag/formats/readers/obj/mtl_reader.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kLargestMtlBytes = std::size_t{64} << 20;

/// Calls body(name, path) for each file that the argument of `mtllib` names: one file with blanks
/// in its name, or several files; a blank in a folder's name ends nothing. Adds a warning for each
/// name outside the OBJ file's folder, and returns whether there is none.
template <class Body>
bool for_each_library(const MeshSource& source, const NamedFiles& files, const NameTable& libraries,
                      Warnings& warnings, const Body& body) {
  bool all_found = true;
  const auto find = [&](std::string_view name) {
    try {
      body(name, files.find(source.folder, name, {source.name, "mtllib"}));
    } catch (const OverMemory&) {
      throw;
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      warnings.add(std::string(error.what()) + ": its materials are grey");
      all_found = false;
    }
  };
  for (std::size_t i = 0; i < libraries.size(); ++i) {
    const std::string_view whole = libraries[i];
    const bool exists =
        files.existing(source.folder, whole, NamedFiles::ByBaseName::kNever).has_value();
    std::string_view rest = exists ? "" : whole;
    bool is_list = false;
    for (std::string_view name; !(name = next_token(rest)).empty();)
      if (lower_case(name).ends_with(".mtl") ||
          files.existing(source.folder, name, NamedFiles::ByBaseName::kAlways)) {
        find(name);
        is_list = true;
      }
    if (!is_list) find(whole);
  }
  return all_found;
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
  bool all_open = true;
  const auto read = [&](std::string_view name, const std::filesystem::path& path) {
    const std::string key = path.lexically_normal().string();
    if (seen.find(key)) return;
    seen.find_or_add(key);
    const std::string printed = printable_path(source.folder, name);
    const auto file = open_library(path, printed, warnings);
    if (file)
      reader.read(file->text(), path.parent_path(), printed);
    else
      all_open = false;
  };
  const bool all_found = for_each_library(source, files, libraries, warnings, read);
  if (auto warning = files.warning(source.name)) warnings.add(std::move(*warning));
  std::size_t missing = 0, first = 0;
  for (std::size_t i = 0; i < materials.size() && !libraries.empty(); ++i)
    if (!reader.complete(i) && !materials[i].name.empty() && missing++ == 0) first = i;
  // A library that is missing has had its warning.
  if (missing > 0 && all_found && all_open)
    warnings.add(source.name + ": no MTL file describes " +
                 (missing == 1 ? "material " + name_in_quotes(materials[first].name) + ": it is"
                               : std::to_string(missing) + " materials, such as " +
                                     name_in_quotes(materials[first].name) + ": they are") +
                 " grey");
  return warnings.take(source.name);
}

void report_obj_libraries(const MeshSource& source, const NameTable& libraries) {
  if (source.options.named_files == nullptr) return;
  Warnings ignored;
  for_each_library(source, NamedFiles(source), libraries, ignored,
                   [](std::string_view, const std::filesystem::path&) {});
}

}  // namespace voxdag
