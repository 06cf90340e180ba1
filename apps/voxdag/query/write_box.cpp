#include "query/write_box.hpp"

#include "voxdag/file/npy.hpp"
#include "voxdag/formats/exports/volume_file.hpp"

namespace voxdag::cli {

void write_box(const std::string& output, const Grid& grid, const Box3i& box,
               const std::vector<float>& values) {
  if (is_volume_name(output)) {
    VolumeFile volume(output, output, grid, box, VolumeFile::Values::kFloat32);
    volume.write(values.data(), values.size() * sizeof(float));
    volume.commit();
    return;
  }
  const Vec3<std::uint64_t> size(box.hi - box.lo);
  NpyWriter writer(output, "<f4", {size.y, size.x}, sizeof(float), size.z);
  writer.write_rows(values.data(), size.z);
  writer.commit();
}

}  // namespace voxdag::cli
