#pragma once
/// Surfaces that close the holes of a mesh.
#include "voxdag/builders/solid/winding/boundary_edges.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Returns triangles that have this boundary and no other: they cap each of the loops that it
/// consists of. Throws OverMemory and Cancelled.
PageVector<QuantizedTriangle> cap_boundary(CountedVector<BoundaryEdge> boundary, Work work);

}  // namespace voxdag
