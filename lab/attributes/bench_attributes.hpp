#pragma once
/// `voxdag bench attributes`: bytes, errors and pictures of a DAG's colours in several codecs.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/runs/scene_runs.hpp"
#include "voxdag/formats/readers/read_options.hpp"

namespace voxdag::lab {

enum class ColorCodec {
  kVoxdag,    ///< COLR chunks of .vdag files.
  kDolonius,  ///< Dolonius and others 2017.
  kEsvo,      ///< The blocks of an ESVO.
};

/// Returns the name of a codec on the command line and in the JSON.
std::string key_of(ColorCodec codec);
inline constexpr ColorCodec kColorCodecs[] = {ColorCodec::kVoxdag, ColorCodec::kDolonius,
                                              ColorCodec::kEsvo};

struct AttributesPlan {
  std::vector<std::string> scenes;  ///< Mesh files, or procedural scenes as NAME or NAME:SIZE.
  std::vector<int> levels;          ///< log2 of the resolutions, ascending. All cells get colours.
  std::vector<double> bounds;       ///< For voxdag: AttributeOptions::color_bound.
  std::vector<double> thresholds;   ///< For Dolonius: see encode_dolonius().
  std::vector<ColorCodec> codecs;
  int views = 4;
  ReadOptions read;  ///< The rights of the readers. The other members are unused.
};

/// The colours of a scene in one codec.
struct ColorResult {
  ColorCodec codec = ColorCodec::kVoxdag;
  double bound = 0;              ///< The bound or the threshold; NaN: the codec has none.
  std::uint64_t bytes = 0;       ///< Without the numbers of cells.
  std::uint64_t wire_bytes = 0;  ///< In the wire form; 0: the codec has none.
  double psnr_db = 0;            ///< Over all channels of all cells; infinite if all are exact.
  std::vector<double> ms_ssim;   ///< One for each view.
  double seconds = 0;            ///< Wall-clock seconds of the encoder, from colours in memory.

  double mean_ms_ssim() const;
};

/// The colours of a scene at one resolution.
struct AttributesRun : SceneRun {
  std::uint64_t cells = 0;
  std::uint64_t index_bytes = 0;  ///< Size of the numbers of cells, which every codec needs.
  double filter_seconds = 0;      ///< Wall-clock, from the mesh and the DAG in memory to colours.
  std::vector<ColorResult> results;

  double bits_per_cell(const ColorResult& result) const;
};

struct AttributesResults {
  std::vector<AttributesRun> runs;
};

/// Builds each scene, filters its colours and encodes them. A scene that fails is a run with a
/// failure. Throws Cancelled.
AttributesResults bench_attributes(const AttributesPlan& plan, Progress& progress);

nlohmann::ordered_json attributes_json(const AttributesResults& results,
                                       const nlohmann::ordered_json& machine);

}  // namespace voxdag::lab
