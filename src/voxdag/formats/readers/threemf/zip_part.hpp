#pragma once
/// Files in a ZIP archive, through minizip.
#include <functional>
#include <string>
#include <string_view>

#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {

/// Unpacks a file of the archive `source` as a stream: calls use(part) for its parts, in order.
/// `name` may begin with '/'. Upper and lower case are one, as in the Open Packaging Conventions.
/// Returns false if the archive has no such file. Throws Error if the archive is damaged, and what
/// `use` throws.
bool read_zip_part(const MeshSource& source, std::string_view name,
                   const std::function<void(std::string_view)>& use);

}  // namespace voxdag
