#pragma once
/// `voxdag render --memory`: pictures of an ESVO whose blocks are loaded while they are made.
#include <vector>

#include "cli/session.hpp"
#include "render/render_arguments.hpp"
#include "render/render_passes.hpp"

namespace voxdag {

/// Renders and writes the picture or the film. Throws Error as StreamBlocks and render_streamed do.
void render_streamed(const RenderArguments& arguments, const std::vector<RenderPass>& passes,
                     Session& session);

}  // namespace voxdag
