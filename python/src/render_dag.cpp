/// Pictures: render, of Dag and of Snapshot.
#include <pybind11/stl.h>

#include <array>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/image/color.hpp"
#include "voxdag/image/jpeg_writer.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

using Triple = std::array<double, 3>;

std::optional<Vec3d> vector_of(const std::optional<Triple>& values) {
  if (!values) return std::nullopt;
  return Vec3d{(*values)[0], (*values)[1], (*values)[2]};
}

ImageRgb8 render(const SceneParts& dag, int width, int height, const std::optional<Triple>& eye,
                 const std::optional<Triple>& target, const std::optional<Triple>& up,
                 std::optional<double> fov, const std::optional<Triple>& sun, int samples,
                 bool shadows, int occlusion, bool colors) {
  if (width < 1 || height < 1 || width > 65536 || height > 65536)
    throw py::value_error("width and height must be 1 to 65536");
  if (samples < 1 || occlusion < 0 || occlusion > RenderLimits::kOcclusionSamples)
    throw py::value_error("samples must be at least 1, occlusion 0 to 4096");
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.view.eye = vector_of(eye);
  options.view.target = vector_of(target);
  options.view.up = vector_of(up);
  options.view.vertical_fov_degrees = fov;
  show_as(dag.presentation, options.view);
  if (dag.presentation.cubes) options.cube_pixels = 0;
  options.ground = true;
  options.sun = vector_of(sun);
  options.samples_per_pixel = samples;
  options.shadows = shadows;
  options.occlusion_samples = occlusion;
  if (colors) options.look = dag.look;
  options.with_normal = options.with_occlusion = options.with_shadow = false;
  return run_work([&](Work work) {
    const RenderedImage image = render_image(dag.scene, dag.grid, options, work);
    ImageRgb8 pixels(width, height);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      for (int c = 0; c < 3; ++c)
        pixels.pixels[3 * i + static_cast<std::size_t>(c)] = linear_to_srgb8(image.rgb[i][c]);
    return pixels;
  });
}

py::array_t<std::uint8_t> array_of_image(const ImageRgb8& image) {
  py::array_t<std::uint8_t> array(
      {py::ssize_t{image.height}, py::ssize_t{image.width}, py::ssize_t{3}});
  std::memcpy(array.mutable_data(), image.pixels.data(), image.pixels.size());
  return array;
}

template <class Shown, class Class>
void define_render(Class& shown) {
  const auto none = py::none();
  shown.def(
      "render",
      [](const Shown& of, int width, int height, const std::optional<Triple>& eye,
         const std::optional<Triple>& target, const std::optional<Triple>& up,
         std::optional<double> fov, const std::optional<Triple>& sun, int samples, bool shadows,
         int occlusion, bool colors) {
        return array_of_image(render(of.parts(), width, height, eye, target, up, fov, sun, samples,
                                     shadows, occlusion, colors));
      },
      py::kw_only(), py::arg("width") = 960, py::arg("height") = 540, py::arg("eye") = none,
      py::arg("target") = none, py::arg("up") = none, py::arg("fov") = none, py::arg("sun") = none,
      py::arg("samples") = 1, py::arg("shadows") = true, py::arg("occlusion") = 64,
      py::arg("colors") = true,
      R"(Renders a picture. Returns (height, width, 3) uint8, sRGB.

width, height: in pixels, 1 to 65536.
eye, target: (x, y, z), where the camera is and what it looks at, in world units.
up: (x, y, z), the direction that points up; sun: the direction towards the sun.
fov: vertical field of view, in degrees. Default of these: a view that shows the scene well.
samples: rays per pixel. occlusion: rays of ambient occlusion per pixel, 0 to 4096.
shadows: of the sun. colors: those of the DAG, else grey.)");
}

}  // namespace

void add_pictures(SnapshotClass& snapshot) { define_render<Snapshot>(snapshot); }

void add_pictures(DagClass& dag) {
  define_render<Dag>(dag);
  dag.def("_jpeg", [](const Dag& d) {
    constexpr int kQuality = 80;
    return py::bytes(
        encode_jpeg(render(d.parts(), 640, 360, {}, {}, {}, {}, {}, 4, true, 64, true), kQuality));
  });
}

}  // namespace voxdag::python
