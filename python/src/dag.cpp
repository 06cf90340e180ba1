#include "dag.hpp"

#include <bit>

namespace py = pybind11;

namespace voxdag::python {

Box3i window_of(const Dag& dag, const std::optional<Window>& window) {
  const Box3i whole = whole_grid(dag.grid().levels);
  if (!window) return whole;
  const auto& [lo, hi] = *window;
  const Box3i box{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
  for (int axis = 0; axis < 3; ++axis)
    if (box.lo[axis] < 0 || box.lo[axis] >= box.hi[axis] || box.hi[axis] > whole.hi[axis])
      throw py::value_error(
          "window must be ((x0, y0, z0), (x1, y1, z1)) in the grid, each end "
          "greater than its start");
  return box;
}

int levels_of(std::int64_t resolution) {
  const auto n = static_cast<std::uint64_t>(resolution);
  if (resolution < (1 << kMinLevels) || resolution > (1 << kMaxLevels) || !std::has_single_bit(n))
    throw py::value_error("resolution must be a power of two from 4 to 1048576");
  return std::countr_zero(n);
}

int axis_of(const std::string& name) {
  const std::size_t axis = std::string("xyz").find(name);
  if (name.size() != 1 || axis == std::string::npos)
    throw py::value_error("axis must be 'x', 'y' or 'z'");
  return static_cast<int>(axis);
}

void warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

}  // namespace voxdag::python
