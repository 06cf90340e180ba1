#include "voxdag/cuda/device_frame.hpp"

#include "voxdag/render/tile.hpp"

namespace voxdag {
namespace {

template <class T>
DeviceBuffer<T> upload_table(const std::vector<T>& table) {
  return upload(std::span<const T>(table), "the tables of samples");
}

template <class T>
void fetch(std::vector<T>& values, const DeviceBuffer<T>& buffer) {
  copy_to_host(values.data(), buffer.data(), values.size() * sizeof(T));
}

}  // namespace

DeviceFrame::DeviceFrame(const RenderPlan& plan, bool with_beams, FilterKind filter)
    : setup_(plan.setup()) {
  const Camera& camera = setup_.camera;
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  const std::size_t beams = static_cast<std::size_t>(beams_across(camera.width)) *
                            static_cast<std::size_t>(beams_across(camera.height));
  const char* what = "the picture";
  const ImageBuffers& wanted = setup_.image;
  const bool with_filter = filter != FilterKind::kNone;
  const auto bytes = [](const auto* values) { return values != nullptr ? sizeof *values : 0; };
  require_device_memory(
      pixels * (bytes(wanted.radiance) + bytes(wanted.depth) + bytes(wanted.normal) +
                bytes(wanted.occlusion) + bytes(wanted.shadow) + bytes(wanted.steps) +
                bytes(wanted.cell_pixels) + bytes(wanted.coverage) + bytes(wanted.albedo) +
                bytes(wanted.cells) + (with_filter ? sizeof(Vec3f) : 0)) +
          (with_beams ? beams * sizeof(float) : 0),
      what);
  const auto make = [&]<class T>(DeviceBuffer<T>& buffer, const T* values) {
    if (values != nullptr) buffer = make_device_buffer<T>(pixels, what);
  };
  make(radiance_, wanted.radiance);
  make(depth_, wanted.depth);
  make(normal_, wanted.normal);
  make(occlusion_, wanted.occlusion);
  make(shadow_, wanted.shadow);
  make(steps_, wanted.steps);
  make(cell_pixels_, wanted.cell_pixels);
  make(coverage_, wanted.coverage);
  make(albedo_, wanted.albedo);
  make(cells_, wanted.cells);
  if (with_beams) beam_starts_ = make_device_buffer<float>(beams, what);
  if (with_filter) {
    filtered_ = make_device_buffer<Vec3f>(pixels, what);
    filter_samples_ = upload(std::span<const FilterSample>(filter_table()), what);
  }
  const unsigned long long none = 0;
  rays_ = upload(std::span(&none, 1), what);

  square_ = upload_table(plan.samples().square());
  disc_ = upload_table(plan.samples().disc());
  rotations_ = upload_table(plan.samples().rotations());
  hemisphere_ = upload_table(plan.samples().hemisphere());
  if (SkyMap& map = setup_.sky.map; map.texels != nullptr) {
    const auto side = static_cast<std::size_t>(map.side);
    environment_ = upload(std::span(map.texels, side * side), "the environment");
    map.texels = environment_.data();
  }
  setup_.tables.square = square_.data();
  setup_.tables.disc = disc_.data();
  setup_.tables.rotations = rotations_.data();
  setup_.tables.hemisphere = hemisphere_.data();
  setup_.image = {radiance_.data(), depth_.data(),   normal_.data(),      occlusion_.data(),
                  shadow_.data(),   steps_.data(),   cell_pixels_.data(), albedo_.data(),
                  cells_.data(),    coverage_.data()};
  setup_.beam_starts = beam_starts_.data();
  if (with_filter) filter_input_ = voxdag::filter_input(setup_.image, camera, filter);
}

void DeviceFrame::copy_to(RenderedImage& image, bool is_filtered) const {
  fetch(image.radiance, is_filtered ? filtered_ : radiance_);
  fetch(image.cell_pixels, cell_pixels_);
  fetch(image.coverage, coverage_);
  fetch(image.albedo, albedo_);
  fetch(image.cells, cells_);
  fetch(image.depth, depth_);
  fetch(image.normal, normal_);
  fetch(image.occlusion, occlusion_);
  fetch(image.shadow, shadow_);
  fetch(image.steps, steps_);
  copy_to_host(&image.rays, rays_.data(), sizeof image.rays);
}

}  // namespace voxdag
