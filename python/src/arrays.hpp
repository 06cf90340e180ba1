#pragma once
/// NumPy arrays to and from the values of the library.
#include <pybind11/numpy.h>

#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "voxdag/core/vec.hpp"

namespace voxdag::python {

/// An argument that NumPy makes an array of: an array of any type, lists of lists, or a tensor of
/// another library in the processor's memory, which NumPy takes without a copy (__array_interface__
/// or DLPack). Raises what NumPy raises for tensors elsewhere, and TypeError if values are masked.
class ArrayLike : public pybind11::array {
 public:
  ArrayLike() = default;
  explicit ArrayLike(pybind11::array of) : pybind11::array(std::move(of)) {}
};

template <class T>
using Array = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// Returns the kind of an array's type, in NumPy's letters: 'b' bool, 'i' and 'u' whole numbers,
/// 'f' real numbers. Raises TypeError, which calls the array `name`, if it is not one of `allowed`.
char kind_of(const pybind11::array& array, const char* name, std::string_view allowed,
             const char* allowed_in_words);

/// Raises ValueError, which calls the array `name`, unless its shape is (N, 3).
void check_rows(const pybind11::array& array, const char* name);

/// Returns the rows of an array of real or whole numbers of shape (N, 3), rounded to T. Raises
/// TypeError for other types and ValueError for other shapes, which call the array `name`.
template <class T>
std::vector<Vec3<T>> rows_of(const pybind11::array& given, const char* name) {
  kind_of(given, name, "iuf", "numbers");
  check_rows(given, name);
  const Array<T> array(given);
  std::vector<Vec3<T>> rows(static_cast<std::size_t>(array.shape(0)));
  if (!rows.empty())
    std::memcpy(static_cast<void*>(rows.data()), array.data(), rows.size() * sizeof(rows[0]));
  return rows;
}

/// Returns the rows of an array of shape (N, 3) whose values are whole, as integers or as real
/// numbers, from `least` to `most`. Raises ValueError for other values, too.
std::vector<Vec3<std::int64_t>> whole_rows_of(const pybind11::array& given, const char* name,
                                              std::int64_t least, std::int64_t most);

/// Returns the values of an array of shape (N,) that are whole, as whole_rows_of() does.
std::vector<std::int64_t> whole_values_of(const pybind11::array& given, const char* name,
                                          std::int64_t least, std::int64_t most);

/// Returns voxels: whole_rows_of() in the range of 32 bits.
std::vector<Vec3i> voxels_of(const pybind11::array& given, const char* name);

/// Returns sRGB colours of shape (N, 3) in 8 bits. uint8 stays; uint16 is scaled from 0 to 65535,
/// or with a warning stays if no value exceeds 255; real numbers are scaled from 0 to 1; other
/// integers must be 0 to 255. Raises TypeError for other types, and ValueError for other values and
/// shapes.
std::vector<Vec3<std::uint8_t>> colors_of(const pybind11::array& given);

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

namespace pybind11::detail {

template <>
struct type_caster<voxdag::python::ArrayLike> {
  PYBIND11_TYPE_CASTER(voxdag::python::ArrayLike, const_name("ArrayLike"));

  bool load(handle source, bool) {
    // array::ensure() drops masks.
    if (module_::import("numpy.ma").attr("is_masked")(source).cast<bool>())
      throw type_error("an array has masked values: replace them first, as array.filled(0) does");
    // NumPy makes arrays of all that has a buffer, __array__ or __array_interface__, but not of
    // what has DLPack alone.
    const bool has_dlpack_alone = !isinstance<array>(source) && hasattr(source, "__dlpack__") &&
                                  !hasattr(source, "__array__") &&
                                  !hasattr(source, "__array_interface__");
    array made = has_dlpack_alone
                     ? module_::import("numpy").attr("from_dlpack")(source).cast<array>()
                     : array::ensure(source);
    if (!made) return false;
    value = voxdag::python::ArrayLike(std::move(made));
    return true;
  }
};

}  // namespace pybind11::detail
