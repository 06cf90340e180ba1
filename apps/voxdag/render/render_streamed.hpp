#pragma once
/// `voxdag render --memory`: pictures of an ESVO whose blocks are loaded on demand.
#include "render/render_arguments.hpp"

namespace voxdag::cli {

/// Renders and writes the picture or the film of the ESVO. Throws Error like StreamBlocks and the
/// library's render_streamed().
void render_streamed(const RenderArguments& arguments, Session& session);

}  // namespace voxdag::cli
