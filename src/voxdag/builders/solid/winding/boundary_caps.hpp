#pragma once
/// Surfaces that close the holes of a mesh.
#include "voxdag/builders/solid/winding/boundary_edges.hpp"
#include "voxdag/core/page_vector.hpp"

namespace voxdag {

/// Returns triangles that have this boundary and no other: they cap each of the loops that it
/// consists of. Throws OverMemory and Cancelled; `memory` and `progress` may be null.
PageVector<QuantizedTriangle> cap_boundary(CountedVector<BoundaryEdge> boundary,
                                           MemoryBudget* memory, Progress* progress);

}  // namespace voxdag
