#pragma once
/// What `voxdag render` is told.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/device.hpp"
#include "cli/parse.hpp"
#include "cli/session.hpp"
#include "render/render_mesh.hpp"
#include "render/render_passes.hpp"
#include "render/render_path.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

struct RenderArguments {
  std::string output, depth, normal;
  std::vector<RenderPass> passes;
  ImageSize size{1920, 1080};
  RenderOptions options;
  std::optional<bool> filter;  ///< Without: for ESVOs.
  MeshArguments mesh;
  PathArguments path;
  DeviceChoice device;
  std::uint64_t stream_memory = 0;  ///< Of an ESVO's blocks, bytes; 0: all are loaded.
};

/// They are set when the command line is read; both must live until then.
void add_render_options(CLI::App& command, Session& session, RenderArguments& arguments);

/// Throws CLI::ValidationError for what no scene can be asked for, or not together.
void check_render_arguments(const RenderArguments& arguments, Session& session);

/// Every picture to write.
std::vector<RenderPass> all_passes(const RenderArguments& arguments);

}  // namespace voxdag
