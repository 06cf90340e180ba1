#include "voxdag/core/error.hpp"
#include "voxdag/image/exr.hpp"

namespace voxdag {

void write_exr(const std::filesystem::path& path, const ImageF&, const std::vector<std::string>&) {
  throw Error(path.string(), "", "cannot write: this voxdag was built without OpenEXR");
}

ImageF decode_exr(std::span<const std::uint8_t>, const std::string& name) {
  throw Error(name, "", "this voxdag was built without OpenEXR");
}

}  // namespace voxdag
