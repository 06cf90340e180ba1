#pragma once
/// Checks packed materials from an untrusted file.
#include "voxdag/stored/attributes/material_ids.hpp"

namespace voxdag {

/// Throws Error unless `view` is what MaterialEncoder makes of some ids. Then read_material() is
/// safe for every number. The arrays of `view` must be as long as it says. Linear time. The place
/// of an error is "page 17".
void validate_material_ids(const MaterialIdsView& view);

}  // namespace voxdag
