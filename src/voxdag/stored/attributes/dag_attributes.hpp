#pragma once
/// The attributes of a DAG in memory, and the bounds on the errors of their values.
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/attributes/value_encoder.hpp"

namespace voxdag {

/// Weights of red, green and blue in errors of colours.
inline constexpr std::array<int, 3> kColorWeights{2, 4, 1};
/// The smallest bound on errors of normals, in degrees: rounding a normal to 8 bits can turn it by
/// almost this angle.
inline constexpr double kMinNormalBound = 0.4;

/// Returns a metric that keeps the angle between stored normals and unit normals, which
/// pack_normal() rounds, within a bound of kMinNormalBound to 180 degrees.
ValueMetric make_normal_metric(double degrees);

/// Attributes in memory. The view is valid while this object lives unchanged.
struct DagAttributes {
  CellIndex index;
  ValuePages colors, normals;
  MaterialIds materials;
  CellChannels channels;
  ValueErrors color_errors, normal_errors;

  DagAttributesView view() const {
    return {index.view(), colors.view(), normals.view(), materials.view(), channels.view()};
  }
  std::uint64_t bytes() const {
    return index.view().bytes() + colors.view().bytes() + normals.view().bytes() +
           materials.view().bytes() + channels.view().bytes();
  }
};

}  // namespace voxdag
