#pragma once
/// The arguments of `voxdag render`.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/device.hpp"
#include "cli/mesh_input.hpp"
#include "cli/scene_input.hpp"
#include "voxdag/image/image_size.hpp"
#include "voxdag/render/film/picture_pass.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag::cli {

/// The options of --mesh: view samples come from triangles.
struct MeshArguments {
  std::string file;  ///< Empty: none.
  MeshAccess access;
  bool grey = false;    ///< Ignores the mesh's colours, textures and normals.
  std::string primary;  ///< "mesh", "voxels" or empty: the mesh if there is one.

  bool is_seen() const { return !file.empty() && primary != "voxels"; }
};

/// The options of --path: the frames of a film.
struct PathArguments {
  std::string file;     ///< The camera path; empty: one picture.
  std::string timings;  ///< A CSV to write, with a plot beside it; empty: none.
  double frames_per_second = 30;
};

/// The option --view, which names settings of the viewer.
struct ViewFileArguments {
  std::string file;                    ///< Empty: none.
  std::vector<Option> winners;         ///< Options that win over the file if they are given.
  bool colors = true, normals = true;  ///< Show the colours, the normals that a DAG stores.

  /// Returns whether this option of `winners`, such as "--eye", is given.
  bool has(const std::string& option) const;
};

struct RenderArguments {
  SceneInput input;
  std::string output, depth, normal;
  std::string environment;                  ///< The file or the name of --environment; empty: none.
  std::string camera_matrix, write_camera;  ///< Files of cameras as matrices; empty: none.
  ViewFileArguments view;
  std::string look;        ///< The file of --look; empty: none.
  bool materials = false;  ///< Show each material in a colour of its own.
  std::string channel;     ///< Show the values of this channel as colours.
  std::optional<ChannelRange> channel_range;
  std::vector<PicturePass> passes;  ///< Values of --pass.
  ImageSize size{1920, 1080};
  RenderOptions options;
  bool filter = false, no_filter = false;      ///< Neither: filter an ESVO.
  FilterKind filter_kind = FilterKind::kNone;  ///< Value of --filter-kind; kNone: not given.
  MeshArguments mesh;
  PathArguments path;
  DeviceChoice device;
  std::uint64_t stream_memory = 0;  ///< Bytes for the blocks of an ESVO; 0: all are loaded.
};

/// Adds all options of `voxdag render`. They store into `arguments` and `session`.
void add_render_options(const Command& command, Session& session, RenderArguments& arguments);

/// Throws UsageError for values or combinations that are wrong for every scene, and for wrong
/// outputs.
void check_render_arguments(RenderArguments& arguments, Session& session);

/// Reads the file of --view, if there is one, and sets the options that the command line does not
/// give. Prints a warning for each setting that it ignores. Throws what read_view_settings()
/// throws.
void apply_view_file(RenderArguments& arguments, Session& session);

/// Reads the files of --environment and --camera-matrix, and sets the options to what they say.
/// Throws Error with the file.
void read_render_files(RenderArguments& arguments);

/// Returns all passes to write: the picture, --depth, --normal and --pass.
std::vector<PicturePass> all_passes(const RenderArguments& arguments);

/// Returns the options of the picture or of each frame. `is_esvo` says whether the scene is an ESVO
/// or a DAG.
RenderOptions picture_options(const RenderArguments& arguments, bool is_esvo);

}  // namespace voxdag::cli
