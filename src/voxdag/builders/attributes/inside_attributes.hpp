#pragma once
/// Computes the attributes of solid bodies: the inside takes the values of the nearest surface.
#include <optional>

#include "voxdag/builders/attributes/build_attributes.hpp"

namespace voxdag {

/// Returns the attributes of `solid` from those of `surface`, a DAG with equally many levels.
/// Cells of both keep their values, encoded again. Other cells take the values of the finest cell
/// of the surface that is nearest to their centre (algebra/query/nearest_voxel.hpp), or
/// `inside_color`, sRGB encoded, if it is given. The bounds are those of `options`; the values of
/// `surface` should be lossless. Time grows with the cells of `solid`. The budget no longer counts
/// the result when the function returns. Throws Error if the surface is empty and the solid is not,
/// OverMemory and Cancelled.
DagAttributes inside_attributes(const ColoredDagView& surface, const SvdagView& solid,
                                const AttributeOptions& options,
                                const std::optional<Value8>& inside_color, Work work = {});

}  // namespace voxdag
