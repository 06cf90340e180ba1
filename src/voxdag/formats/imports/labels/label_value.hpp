#pragma once
/// Labels in files: their fields and values.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/number_text.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// The names of the fields that usually hold labels, in small letters. The first one that a file
/// has is read.
inline constexpr std::string_view kLabelFields[] = {
    "label",        "labels",          "class",    "classification", "scalar_classification",
    "scalar_label", "semantic",        "category", "object_id",      "instance",
    "instance_id",  "scalar_instance", "material"};

/// Returns the index, from 0 to `count`, of the field that has the labels. `name_of(i)` is the name
/// of field i. `wanted` is VoxelSourceOptions::labels. Capitals do not matter. Throws Error,
/// without a file, if there is none.
template <class NameOf>
std::size_t find_label_field(const std::string& wanted, std::size_t count, const NameOf& name_of) {
  const auto find = [&](std::string_view name) {
    std::size_t i = 0;
    while (i < count && lower_case(std::string(name_of(i))) != name) ++i;
    return i;
  };
  std::size_t found = count;
  if (!wanted.empty())
    found = find(lower_case(wanted));
  else
    for (const std::string_view name : kLabelFields)
      if (found == count) found = find(name);
  if (found < count) return found;
  std::string names;
  for (std::size_t i = 0; i < count; ++i) names += (i > 0 ? ", " : "") + std::string(name_of(i));
  throw Error("", "",
              (wanted.empty() ? "has no field that is known to hold labels"
                              : "has no field " + in_quotes(wanted)) +
                  "; its fields are " + (names.empty() ? "without names" : names));
}

/// Returns whether labels are wanted of a format that has one label for each voxel, and no fields.
/// Throws Error, without a file, if a field is named.
inline bool wants_labels(const LabelRequest& labels) {
  if (labels && !labels->empty())
    throw Error("", "", "has no fields, of which " + in_quotes(*labels) + " could have labels");
  return labels.has_value();
}

/// Returns the label that a number of a file stands for. Throws Error, without a file, for numbers
/// that are not whole or beyond 2^53.
template <class Number>
Label label_of(Number value) {
  const auto real = static_cast<double>(value);
  if (!(std::abs(real) <= 0x1p53) || real != std::trunc(real))
    throw Error(
        "", "",
        "has the label " + number_text(real) + ", and labels are whole numbers from -2^53 to 2^53");
  return static_cast<Label>(value);
}

}  // namespace voxdag
