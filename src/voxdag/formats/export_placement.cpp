#include "voxdag/formats/export_placement.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "voxdag/algebra/reorient.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/formats/input_file.hpp"

namespace voxdag {

nlohmann::json read_placement(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  if (const auto size = std::filesystem::file_size(file, error); error || size > kMaxBytes)
    return {};
  const MappedFile mapping(file, MappedFile::Access::kSequential);
  auto json = nlohmann::json::parse(mapping.text(), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("placement") || !json.contains("grid")) return {};
  return json;
}

Vec3d offset_beside(const std::filesystem::path& file) {
  for (const std::filesystem::path& name : {file, unpacked_name(file)}) {
    const nlohmann::json json = read_placement(name.string() + ".json");
    const nlohmann::json offset = json.is_null() ? json : json.value("offset", nlohmann::json());
    if (!offset.is_array() || offset.size() != 3) continue;
    Vec3d sum;
    for (int axis = 0; axis < 3; ++axis) {
      const nlohmann::json& item = offset[static_cast<std::size_t>(axis)];
      sum[axis] = item.is_number() ? item.get<double>() : HUGE_VAL;
    }
    if (!is_finite(sum)) throw Error(name.string() + ".json", "offset", "is not three numbers");
    return sum;
  }
  return {};
}

Orientation turn_of_export(char from_up) { return rotated(0, from_up == 'y' ? 1 : -1); }

}  // namespace voxdag
