#pragma once
/// NumPy arrays to and from the values of the library.
#include <pybind11/numpy.h>

#include <cstring>
#include <string>
#include <vector>

#include "voxdag/core/vec.hpp"

namespace voxdag::python {

template <class T>
using Array = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// Returns the rows of an array of shape (N, 3). Raises ValueError, which calls the array `name`,
/// for other shapes.
template <class T>
std::vector<Vec3<T>> rows_of(const Array<T>& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw pybind11::value_error(std::string(name) + " must have the shape (N, 3)");
  std::vector<Vec3<T>> rows(static_cast<std::size_t>(array.shape(0)));
  if (!rows.empty())
    std::memcpy(static_cast<void*>(rows.data()), array.data(), rows.size() * sizeof(rows[0]));
  return rows;
}

/// Returns an array of shape (N, 3).
template <class T>
pybind11::array_t<T> array_of(const std::vector<Vec3<T>>& rows) {
  pybind11::array_t<T> array({static_cast<pybind11::ssize_t>(rows.size()), pybind11::ssize_t{3}});
  if (!rows.empty()) std::memcpy(array.mutable_data(), rows.data(), rows.size() * sizeof(rows[0]));
  return array;
}

/// Returns an array of shape (N,).
template <class T>
pybind11::array_t<T> array_of(const std::vector<T>& values) {
  pybind11::array_t<T> array(static_cast<pybind11::ssize_t>(values.size()));
  if (!values.empty()) std::memcpy(array.mutable_data(), values.data(), values.size() * sizeof(T));
  return array;
}

}  // namespace voxdag::python
